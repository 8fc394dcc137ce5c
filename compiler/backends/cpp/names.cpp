// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/cpp/names.hpp"

#include <algorithm>
#include <utility>
#include <variant>

#include "compiler/backends/cpp/backend.hpp"
#include "compiler/backends/implements.hpp"
#include "compiler/backends/words.hpp"

namespace robdef::cpp {
std::string identifier(std::string_view name) {
  return std::string(name) + (is_reserved(name) ? "_" : "");
}

std::string namespace_of(std::string_view service) {
  std::vector<std::string> segments = segments_of(service);
  for (std::string& segment : segments) segment = identifier(segment);
  if (is_global_name(segments.front())) segments.front() += '_';
  return join(segments, "::");
}

std::string path_of(std::string_view service) { return replace_all(service, ".", "/"); }

std::string qualified(const model::Definition& definition, std::string_view identifier) {
  return "::" + namespace_of(definition.name) + "::" + std::string(identifier);
}

std::string stub_name(const model::Object& object) { return code_name(object) + "Stub"; }
std::string skeleton_name(const model::Object& object) { return code_name(object) + "Skeleton"; }
std::string default_name(const model::Object& object) { return code_name(object) + "Default"; }

bool has_default(const model::Object& object) { return runtime_abilities.must_implement(object); }

std::string table_name(std::string_view what, std::string_view name) {
  return "rr_" + std::string(what) + "_" + std::string(name);
}

Names::Names(const model::Definition& definition, const model::Model& model, Report& report)
    : definition_(&definition) {
  const auto segments = segments_of(definition.name);
  for (const std::string& segment : segments) {
    report_renamed(segment, identifier(segment), cpp_language.shown, definition.span, report);
  }
  NameSet names(cpp_language, report);
  add_declarations(names, report);
  for (const model::Alias& alias : definition.aliases) {
    const std::string name = identifier(alias.name);
    report_renamed(alias.name, name, cpp_language.shown, alias.span, report);
    names.add(name, alias.span, "alias", "");
    taken_.emplace(name, Taken{alias.span, ""});
    aliases_.emplace(alias.qualified_name, name);
  }
  check_inner_namespaces(model, report);
}

void Names::add_declarations(NameSet& names, Report& report) {
  const auto add = [&](const std::string& name, const auto& declared, std::string_view what) {
    const std::string path = definition_->name + "." + declared.name;
    names.add(name, declared.span, what, path);
    taken_.emplace(name, Taken{declared.span, path});
  };
  const auto add_plain = [&](const auto& declared, std::string_view what) {
    const std::string name = identifier(code_name(declared));
    report_renamed(code_name(declared), name, cpp_language.shown, declared.span, report);
    add(name, declared, what);
  };
  for (const model::Constant& constant : definition_->constants) add_plain(constant, "constant");
  for (const model::Exception& exception : definition_->exceptions) {
    add_plain(exception, "exception");
  }
  for (const model::Enum& enumeration : definition_->enums) add_plain(enumeration, "enum");
  for (const model::Record& record : definition_->records) {
    add_plain(record, model::name_of(record.kind));
  }
  for (const model::Object& object : definition_->objects) {
    add(stub_name(object), object, "stub");
    add(skeleton_name(object), object, "skeleton");
    if (has_default(object)) add(default_name(object), object, "default class");
    add(identifier(code_name(object)), object, "object");
  }
}

/// A service `a.b.c` opens the namespace `c` inside that of `a.b`.
void Names::check_inner_namespaces(const model::Model& model, Report& report) {
  const std::string outer = definition_->name + ".";
  for (const auto& other : model.definitions()) {
    if (!other->name.starts_with(outer)) continue;
    const std::string inner = segments_of(other->name.substr(outer.size())).front();
    const auto taken = taken_.find(identifier(inner));
    if (taken == taken_.end()) continue;
    Diagnostic& diagnostic =
        report.add(Code::R0901, taken->second.span,
                   "`" + inner + "` is also a C++ namespace, of the service `" + other->name + "`");
    diagnostic.label("a type or constant of the same name");
    help_rename(diagnostic, cpp_language, taken->second.path);
  }
}

std::string Names::type_of(const model::Definition& definition, const std::string& wire_name,
                           const std::string& name, const std::set<std::string>& hidden) const {
  std::string known;
  if (&definition == definition_) {
    known = identifier(name);
  } else if (const auto alias = aliases_.find(definition.name + "." + wire_name);
             alias != aliases_.end()) {
    known = alias->second;
  }
  if (known.empty()) return qualified(definition, identifier(name));
  return hidden.contains(known) ? qualified(*definition_, known) : known;
}

std::string Names::type(const model::Record& record, const std::set<std::string>& hidden) const {
  return type_of(*record.definition, record.name, code_name(record), hidden);
}

std::string Names::type(const model::Enum& enumeration, const std::set<std::string>& hidden) const {
  return type_of(*enumeration.definition, enumeration.name, code_name(enumeration), hidden);
}

std::string Names::object_class(const model::Object& object, std::string_view class_name,
                                const std::set<std::string>& hidden) const {
  std::string name(class_name);
  const bool is_plain = object.definition == definition_ && !hidden.contains(name);
  return is_plain ? name : qualified(*object.definition, name);
}

bool Names::is_variable(std::string_view name) const {
  const auto is_called = [&](const auto& declared) {
    return identifier(code_name(declared)) == name;
  };
  const auto is_alias = [&](const model::Alias& alias) { return identifier(alias.name) == name; };
  return std::ranges::any_of(definition_->constants, is_called) ||
         std::ranges::any_of(definition_->aliases, is_alias);
}

std::string Names::local(std::string_view name, std::set<std::string>& taken) const {
  std::string result = as_variable(identifier(name));
  if (result.starts_with("rr")) result.insert(0, "p_");
  while (taken_.contains(result) || taken.contains(result)) result += '_';
  taken.insert(result);
  return result;
}

RecordNames::RecordNames(const model::Record& record, Report& report) {
  const std::string own = identifier(code_name(record));
  NameSet taken(cpp_language, report);
  const auto add = [&](const auto& part, std::string_view what) {
    const std::string& name = code_name(part);
    std::string result = identifier(name);
    if (result == own) result += '_';
    report_renamed(name, result, cpp_language.shown, part.span, report);
    taken.add(result, part.span, what, record.qualified_name() + "." + part.name);
    hidden_.insert(result);
    names_.emplace(part.name, std::move(result));
  };
  for (const model::Constant& constant : record.constants) add(constant, "constant");
  for (const model::Field& field : record.fields) add(field, "field");
}

const std::string& RecordNames::of(std::string_view name) const {
  return names_.find(name)->second;
}

std::string member_name(const model::Object& object, const model::Member& member) {
  std::string result = identifier(code_name(member));
  if (result == stub_name(object) || result == skeleton_name(object) ||
      result == default_name(object)) {
    result += '_';
  }
  return result;
}

std::set<std::string> names_inside(const model::Object& object) {
  std::set<std::string> names;
  for (const model::Member& member : object.members) names.insert(member_name(object, member));
  for (const model::Object* base : object.implements) names.merge(names_inside(*base));
  return names;
}

void check_members(const model::Object& object, Report& report) {
  NameSet names(cpp_language, report);
  for (const model::Member& member : object.members) {
    // Properties and objrefs appear as get_ and set_ only.
    const bool is_prefixed =
        member.kind == model::MemberKind::property || member.kind == model::MemberKind::objref;
    const std::string name = is_prefixed ? "get_" + code_name(member) : member_name(object, member);
    names.add(name, member.span, model::name_of(member.kind), full_name(object, member));
    if (is_prefixed) continue;
    report_renamed(code_name(member), name, cpp_language.shown, member.span, report);
  }
  NameSet constants(cpp_language, report);
  for (const model::Constant& constant : object.constants) {
    constants.add(identifier(code_name(constant)), constant.span, "constant",
                  object.qualified_name() + "." + constant.name);
  }
}

}  // namespace robdef::cpp
