// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <deque>
#include <ostream>
#include <rr/error.hpp>
#include <rr/printable.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cli/live/describe.hpp"
#include "cli/live/members.hpp"
#include "compiler/output/json.hpp"

namespace robdef::live {
namespace {

namespace dynamic = rr::dynamic;
using dynamic::Definitions;
using dynamic::Kind;
using dynamic::MemberDescription;
using dynamic::ValueType;

std::vector<const char*> modifiers(std::uint8_t access) {
  constexpr std::array<std::pair<rr::Access, const char*>, 7> names = {
      {{rr::readonly, "readonly"},
       {rr::writeonly, "writeonly"},
       {rr::unreliable, "unreliable"},
       {rr::nolock, "nolock"},
       {rr::nolockread, "nolockread"},
       {rr::perclient, "perclient"},
       {rr::urgent, "urgent"}}};
  std::vector<const char*> found;
  for (const auto& [bit, name] : names) {
    if ((access & bit) != 0) found.push_back(name);
  }
  return found;
}

class Describer {
 public:
  explicit Describer(const Definitions& types) : types_(types) {}

  std::string service(const dynamic::Object& root) {
    json_.begin_object().member("service", root.path()).member("object", root.type_name());
    objects_from(root.type_name());
    return finish();
  }
  std::string object(const std::string& type) {
    json_.begin_object().member("object", type).key("objects").begin_object();
    write_object(type);
    json_.end_object();
    return finish();
  }
  std::string member(const MemberDescription& member) {
    json_.begin_object().key("member");
    write_member(member);
    return finish();
  }

 private:
  void objects_from(const std::string& root) {
    json_.key("objects").begin_object();
    std::deque<std::string> waiting = {root};
    std::set<std::string> seen = {root};
    while (!waiting.empty()) {
      const std::string type = waiting.front();
      waiting.pop_front();
      for (const MemberDescription& member : write_object(type)) {
        if (member.object_type.empty() || !seen.insert(member.object_type).second) continue;
        waiting.push_back(member.object_type);
      }
    }
    json_.end_object();
  }

  std::vector<MemberDescription> write_object(const std::string& type) {
    std::vector<MemberDescription> members = types_.members(type);
    json_.key(type).begin_object().member("documentation", types_.documentation(type));
    json_.key("members").begin_array();
    for (const MemberDescription& member : members) write_member(member);
    json_.end_array().end_object();
    return members;
  }

  void write_member(const MemberDescription& member) {
    json_.begin_object().member("kind", kind_of(member)).member("name", member.name);
    json_.member("declaration", member.declaration);
    json_.member("documentation", member.documentation);
    if (member.kind == rr::MemberKind::objref) {
      json_.member("object", member.object_type.empty() ? "varobject" : member.object_type);
      const bool is_number = member.index == rr::IndexForm::int32;
      if (member.index != rr::IndexForm::none)
        json_.member("index", is_number ? "int32" : "string");
    } else if (member.kind != rr::MemberKind::event) {
      write_type("type", member.type);
    }
    const bool has_parameters = member.kind == rr::MemberKind::function ||
                                member.kind == rr::MemberKind::event ||
                                member.kind == rr::MemberKind::callback;
    if (has_parameters) write_parameters(member);
    if (member.generator != rr::GeneratorForm::none) {
      json_.member("is_generator", true);
      write_type("step", member.generator_parameter);
    }
    json_.key("modifiers").begin_array();
    for (const char* const name : modifiers(member.access)) json_.value(name);
    json_.end_array().end_object();
  }

  void write_parameters(const MemberDescription& member) {
    json_.key("parameters").begin_array();
    for (const dynamic::ParameterDescription& parameter : member.parameters) {
      json_.begin_object().member("name", parameter.name);
      write_type("type", parameter.type);
      json_.end_object();
    }
    json_.end_array();
  }

  void write_type(const char* key, const ValueType& type) {
    json_.member(key, type.text());
    note(type);
  }

  // A named type, and those below it, to be described at the end.
  void note(const ValueType& type) {
    const Kind kind = type.kind();
    if (kind == Kind::list || kind == Kind::int_map || kind == Kind::string_map ||
        (kind == Kind::array && !type.name().empty())) {
      note(type.item());
    } else if ((kind == Kind::record || kind == Kind::enumeration) &&
               noted_.insert(type.name()).second) {
      waiting_.push_back(type);
    }
  }

  void write_named(const ValueType& type) {
    constexpr std::array<const char*, 3> kinds = {"struct", "pod", "namedarray"};
    json_.key(type.name()).begin_object();
    if (type.kind() == Kind::enumeration) {
      json_.member("kind", "enum").key("values").begin_object();
      for (const auto& [name, number] : type.enum_values()) json_.member(name, number);
      json_.end_object().end_object();
      return;
    }
    json_.member("kind", kinds.at(static_cast<std::size_t>(type.record_kind())));
    json_.key("fields").begin_array();
    for (const dynamic::Field& field : type.fields()) {
      json_.begin_object().member("name", field.name);
      write_type("type", field.type);
      json_.member("documentation", field.documentation).end_object();
    }
    json_.end_array().end_object();
  }

  std::string finish() {
    json_.key("types").begin_object();
    while (!waiting_.empty()) {
      const ValueType type = waiting_.front();
      waiting_.pop_front();
      write_named(type);
    }
    json_.end_object().end_object();
    return std::move(json_).text();
  }

  const Definitions types_;
  JsonWriter json_;
  std::set<std::string> noted_;
  std::deque<ValueType> waiting_;
};

}  // namespace

void describe_json(const dynamic::Object& root, std::string_view path, std::ostream& out) {
  if (path.empty()) {
    out << rr::printable_json(Describer(root.types()).service(root));
    return;
  }
  const ObjectPath steps = parse_object_path(path);
  const ObjectPath above(steps.begin(), steps.end() - 1);
  const TypeAt type = object_type_at(root, above);
  for (const dynamic::MemberDescription& member : type.members()) {
    if (member.name != steps.back().name) continue;
    if (member.kind != rr::MemberKind::objref) {
      out << rr::printable_json(Describer(type.types).member(member));
    } else if (!member.object_type.empty()) {
      out << rr::printable_json(Describer(type.types).object(member.object_type));
    } else {
      const TypeAt behind = object_type_at(root, steps);
      out << rr::printable_json(Describer(behind.types).object(behind.name));
    }
    return;
  }
  (void)object_at(root, above).member(steps.back().name);  // throws
}

}  // namespace robdef::live
