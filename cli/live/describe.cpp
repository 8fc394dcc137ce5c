// SPDX-License-Identifier: Apache-2.0
#include "cli/live/describe.hpp"

#include <algorithm>
#include <optional>
#include <ostream>
#include <rr/printable.hpp>
#include <vector>

namespace robdef::live {
namespace {

namespace dynamic = rr::dynamic;
using dynamic::Definitions;
using dynamic::MemberDescription;
using dynamic::Object;

std::optional<MemberDescription> find_member(const TypeAt& type, const std::string& name) {
  for (const MemberDescription& member : type.members()) {
    if (member.name == name) return member;
  }
  return std::nullopt;
}

void print_documentation(const std::string& text, const std::string& indent, std::ostream& out) {
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    out << indent << rr::printable(text.substr(begin, end - begin), rr::printable_whole) << '\n';
    begin = end + 1;
  }
}

void print_member(const MemberDescription& member, const std::string& indent, std::ostream& out) {
  out << indent << rr::printable(member.declaration, rr::printable_whole) << '\n';
  print_documentation(member.documentation, indent + "    ", out);
}

void print_object(const TypeAt& type, std::ostream& out) {
  out << "object " << rr::printable(type.name) << '\n';
  print_documentation(type.types.documentation(type.name), "    ", out);
  for (const MemberDescription& member : type.members()) print_member(member, "  ", out);
}

}  // namespace

TypeAt object_type_at(const Object& root, const ObjectPath& path) {
  TypeAt type{root.types(), root.type_name()};
  for (const PathStep& step : path) {
    const auto member = find_member(type, step.name);
    // What is wrong with it says the step itself, and so does the service behind a varobject.
    if (!member || member->kind != rr::MemberKind::objref || member->object_type.empty()) {
      const Object object = object_at(root, path);
      return {object.types(), object.type_name()};
    }
    type.name = member->object_type;
  }
  return type;
}

void list_members(const Object& root, const ObjectPath& path, std::ostream& out) {
  for (const MemberDescription& member : object_type_at(root, path).members()) {
    out << rr::printable(member.declaration, rr::printable_whole) << '\n';
  }
}

void describe_text(const Object& root, std::string_view path, std::ostream& out) {
  if (path.empty()) {
    const Definitions types = root.types();
    out << "service " << rr::printable(root.path()) << ", object "
        << rr::printable(root.type_name()) << '\n';
    for (const std::string& service : types.services()) {
      out << '\n'
          << rr::printable(types.outline(service), rr::printable_whole, rr::LineBreaks::kept);
    }
    return;
  }
  const ObjectPath steps = parse_object_path(path);
  const PathStep& last = steps.back();
  const ObjectPath above(steps.begin(), steps.end() - 1);
  const TypeAt type = object_type_at(root, above);
  const auto member = find_member(type, last.name);
  if (!member) (void)object_at(root, above).member(last.name);  // throws
  if (!last.index) print_member(*member, "", out);
  if (member->kind != rr::MemberKind::objref) return;
  if (!member->object_type.empty()) {
    print_object({type.types, member->object_type}, out);
  } else if (last.index || member->index == rr::IndexForm::none) {
    print_object(object_type_at(root, steps), out);
  }
}

}  // namespace robdef::live
