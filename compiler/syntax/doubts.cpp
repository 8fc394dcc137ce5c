// SPDX-License-Identifier: Apache-2.0
// Looks at names as they are written. Reports the warnings R0223, R0521, R0621, R0622, R0625.
#include "compiler/syntax/doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

#include "compiler/syntax/words.hpp"

namespace robdef::syntax {
namespace {

// Names that were met, each with its first place.
using Seen = std::unordered_map<std::string_view, Span>;

std::string in_ticks(std::string_view text) { return fmt::format("`{}`", text); }

// What other places would have against a name; empty for a good one.
std::string objection(std::string_view name) {
  if (is_reserved_word(name)) return "a reserved word";
  if (name == "this" || name == "self" || name == "Me") return "a word of many languages";
  if (!is_letter(name.front())) return "does not begin with a letter";
  if (name.back() == '_') return "ends in an underscore";
  if (has_reserved_prefix(name)) return "has a prefix that generated code uses";
  return {};
}

void doubt_segments(const ast::Name& service, Report& report) {
  const std::string_view name = service.text;
  if (name.find('.') == name.npos) return;
  for (std::size_t begin = 0; begin <= name.size();) {
    const std::size_t end = std::min(name.find('.', begin), name.size());
    const std::string_view segment = name.substr(begin, end - begin);
    const auto offset = static_cast<std::uint32_t>(begin);
    const Span span{service.span.source, service.span.begin + offset,
                    service.span.begin + offset + static_cast<std::uint32_t>(segment.size())};
    // A reserved prefix is no more than usual: published definitions begin `com.robotraconteur`.
    if (is_reserved_word(segment)) {
      report.add(Code::R0223, span, fmt::format("{} in a service name", in_ticks(segment)))
          .label(objection(segment));
    }
    begin = end + 1;
  }
}

void doubt_imports(const ast::File& file, Report& report) {
  Seen imports;
  for (const ast::Import& import : file.imports) {
    const auto [first, is_new] = imports.try_emplace(import.name.text, import.name.span);
    if (is_new) continue;
    report
        .add(Code::R0521, import.name.span,
             fmt::format("{} is imported twice", in_ticks(import.name.text)))
        .also(first->second, "first here");
  }
  Seen types;
  for (const ast::Using& written : file.usings) {
    const ast::Name& type = written.qualified;
    const auto [first, is_new] = types.try_emplace(type.text, type.span);
    if (is_new) continue;
    report.add(Code::R0521, type.span, fmt::format("two aliases for {}", in_ticks(type.text)))
        .also(first->second, "the first alias");
  }
}

void doubt_parameters(const ast::Member& member, Report& report) {
  for (const ast::Parameter& parameter : member.parameters) {
    const std::string why = objection(parameter.name.text);
    if (why.empty()) continue;
    report
        .add(Code::R0621, parameter.name.span,
             fmt::format("a parameter with the name {}", in_ticks(parameter.name.text)))
        .label(why);
  }
  if (member.parameters.empty()) return;
  const ast::Parameter& last = member.parameters.back();
  if (last.type.container != ast::ContainerForm::generator) return;
  for (const ast::Parameter& parameter : member.parameters) {
    if (&parameter == &last || parameter.name.text != last.name.text) continue;
    report
        .add(Code::R0622, last.name.span,
             fmt::format("the generator {} has the name of another parameter",
                         in_ticks(last.name.text)))
        .also(parameter.name.span, "the other parameter");
    return;
  }
}

void doubt_implements(const ast::Object& object, Report& report) {
  Seen seen;
  for (const ast::Implements& written : object.implements) {
    const auto [first, is_new] = seen.try_emplace(written.name.text, written.name.span);
    if (is_new) continue;
    report
        .add(Code::R0625, written.name.span,
             fmt::format("{} is implemented twice", in_ticks(written.name.text)))
        .also(first->second, "first here");
  }
}

}  // namespace

void doubt_names(const ast::File& file, Report& report) {
  if (file.service) doubt_segments(*file.service, report);
  doubt_imports(file, report);
  for (const ast::Declaration& declaration : file.declarations) {
    const auto* const object = std::get_if<ast::Object>(&declaration);
    if (object == nullptr) continue;
    doubt_implements(*object, report);
    for (const ast::Member& member : object->members) doubt_parameters(member, report);
  }
}

}  // namespace robdef::syntax
