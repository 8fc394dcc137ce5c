// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/cpp/names.hpp"

#include <algorithm>
#include <utility>
#include <variant>

#include "compiler/backends/cpp/backend.hpp"
#include "compiler/backends/words.hpp"

namespace robdef::cpp {
namespace {

void report_renamed(std::string_view name, const std::string& renamed, Span span, Report& report) {
  if (renamed == name) return;
  report.add(Code::R0903, span, "`" + std::string(name) + "` is reserved in C++")
      .label("becomes `" + renamed + "`");
}

}  // namespace

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

std::string stub_name(const model::Object& object) { return object.name + "Stub"; }
std::string skeleton_name(const model::Object& object) { return object.name + "Skeleton"; }
std::string default_name(const model::Object& object) { return object.name + "Default"; }

bool has_default(const model::Object& object) {
  return std::ranges::any_of(object.members, [](const model::Member& member) {
    return member.kind == model::MemberKind::property ||
           (member.kind == model::MemberKind::memory && runtime_abilities.serve(member));
  });
}

std::string table_name(std::string_view what, std::string_view name) {
  return "rr_" + std::string(what) + "_" + std::string(name);
}

Names::Names(const model::Definition& definition, const model::Model& model, Report& report)
    : definition_(&definition) {
  const auto segments = segments_of(definition.name);
  for (const std::string& segment : segments) {
    report_renamed(segment, identifier(segment), definition.span, report);
  }
  add_declarations(report);
  for (const model::Alias& alias : definition.aliases) {
    const std::string name = identifier(alias.name);
    report_renamed(alias.name, name, alias.span, report);
    add(name, alias.span, "alias", report);
    aliases_.emplace(alias.qualified_name, name);
  }
  check_inner_namespaces(model, report);
}

void Names::add_declarations(Report& report) {
  const auto add_plain = [&](const auto& declared, std::string_view what) {
    const std::string name = identifier(declared.name);
    report_renamed(declared.name, name, declared.span, report);
    add(name, declared.span, what, report);
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
    add(stub_name(object), object.span, "stub", report);
    add(skeleton_name(object), object.span, "skeleton", report);
    if (has_default(object)) add(default_name(object), object.span, "default class", report);
    add(identifier(object.name), object.span, "object", report);
  }
}

void Names::add(const std::string& name, Span span, std::string_view what, Report& report) {
  const auto [place, is_new] = taken_.emplace(name, span);
  if (is_new) return;
  report.add(Code::R0901, span, "the C++ name `" + name + "` is made twice")
      .label("the " + std::string(what) + " made here")
      .also(place->second, "is called like this one");
}

/// A service `a.b.c` opens the namespace `c` inside that of `a.b`.
void Names::check_inner_namespaces(const model::Model& model, Report& report) {
  const std::string outer = definition_->name + ".";
  for (const auto& other : model.definitions()) {
    if (!other->name.starts_with(outer)) continue;
    const std::string inner = segments_of(other->name.substr(outer.size())).front();
    const auto taken = taken_.find(identifier(inner));
    if (taken == taken_.end()) continue;
    report
        .add(Code::R0901, taken->second,
             "`" + inner + "` is also a C++ namespace, of the service `" + other->name + "`")
        .label("a type or constant of the same name");
  }
}

std::string Names::type_of(const model::Definition& definition, const std::string& name,
                           const std::set<std::string>& hidden) const {
  std::string known;
  if (&definition == definition_) {
    known = identifier(name);
  } else if (const auto alias = aliases_.find(definition.name + "." + name);
             alias != aliases_.end()) {
    known = alias->second;
  }
  if (known.empty()) return qualified(definition, identifier(name));
  return hidden.contains(known) ? qualified(*definition_, known) : known;
}

std::string Names::type(const model::Record& record, const std::set<std::string>& hidden) const {
  return type_of(*record.definition, record.name, hidden);
}

std::string Names::type(const model::Enum& enumeration, const std::set<std::string>& hidden) const {
  return type_of(*enumeration.definition, enumeration.name, hidden);
}

std::string Names::object_class(const model::Object& object, std::string_view class_name,
                                const std::set<std::string>& hidden) const {
  std::string name(class_name);
  const bool is_plain = object.definition == definition_ && !hidden.contains(name);
  return is_plain ? name : qualified(*object.definition, name);
}

bool Names::is_variable(std::string_view name) const {
  const auto is_called = [&](const auto& declared) { return identifier(declared.name) == name; };
  return std::ranges::any_of(definition_->constants, is_called) ||
         std::ranges::any_of(definition_->aliases, is_called);
}

std::string Names::local(std::string_view name, std::set<std::string>& taken) const {
  std::string result = identifier(name);
  const bool begins_badly = !result.empty() && result.front() >= '0' && result.front() <= '9';
  if (begins_badly || result.starts_with("rr")) result.insert(0, "p_");
  while (taken_.contains(result) || taken.contains(result)) result += '_';
  taken.insert(result);
  return result;
}

RecordNames::RecordNames(const model::Record& record, Report& report) {
  const std::string own = identifier(record.name);
  const auto add = [&](const std::string& name, Span span) {
    std::string result = identifier(name);
    if (result == own) result += '_';
    report_renamed(name, result, span, report);
    hidden_.insert(result);
    names_.emplace(name, std::move(result));
  };
  for (const model::Constant& constant : record.constants) add(constant.name, constant.span);
  for (const model::Field& field : record.fields) add(field.name, field.span);
}

const std::string& RecordNames::of(std::string_view name) const {
  return names_.find(name)->second;
}

std::string member_name(const model::Object& object, std::string_view name) {
  std::string result = identifier(name);
  if (result == stub_name(object) || result == skeleton_name(object) ||
      result == default_name(object)) {
    result += '_';
  }
  return result;
}

std::set<std::string> names_inside(const model::Object& object) {
  std::set<std::string> names;
  for (const model::Member& member : object.members) {
    names.insert(member_name(object, member.name));
  }
  for (const model::Object* base : object.implements) names.merge(names_inside(*base));
  return names;
}

void report_renamed_members(const model::Object& object, Report& report) {
  for (const model::Member& member : object.members) {
    // Properties and objrefs appear as get_ and set_ only.
    if (member.kind == model::MemberKind::property || member.kind == model::MemberKind::objref) {
      continue;
    }
    report_renamed(member.name, member_name(object, member.name), member.span, report);
  }
}

}  // namespace robdef::cpp
