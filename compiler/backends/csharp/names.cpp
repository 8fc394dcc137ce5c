// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/csharp/names.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "compiler/backends/csharp/backend.hpp"
#include "compiler/backends/words.hpp"

namespace robdef::csharp {
namespace {

constexpr auto keywords = std::to_array<std::string_view>(
    {"abstract",  "as",       "base",       "bool",   "break",    "byte",      "case",
     "catch",     "char",     "checked",    "class",  "const",    "continue",  "decimal",
     "default",   "delegate", "do",         "double", "else",     "enum",      "event",
     "explicit",  "extern",   "false",      "field",  "finally",  "fixed",     "float",
     "for",       "foreach",  "goto",       "if",     "implicit", "in",        "int",
     "interface", "internal", "is",         "lock",   "long",     "namespace", "new",
     "null",      "object",   "operator",   "out",    "override", "params",    "private",
     "protected", "public",   "readonly",   "ref",    "return",   "sbyte",     "sealed",
     "short",     "sizeof",   "stackalloc", "static", "string",   "struct",    "switch",
     "this",      "throw",    "true",       "try",    "typeof",   "uint",      "ulong",
     "unchecked", "unsafe",   "ushort",     "using",  "virtual",  "void",      "volatile",
     "while"});

constexpr auto inherited_names = std::to_array<std::string_view>(
    {"Clone", "EqualityContract", "Equals", "Finalize", "GetHashCode", "GetType", "MemberwiseClone",
     "PrintMembers", "ReferenceEquals", "ToString"});

}  // namespace

std::string pascal(std::string_view name) { return pascal_case(without_capitals(name)); }

std::string camel(std::string_view name) {
  const std::string result = camel_case(without_capitals(name));
  return is_keyword(result) ? "@" + result : result;
}

bool is_keyword(std::string_view word) {
  return std::ranges::find(keywords, word) != keywords.end();
}

bool is_inherited_name(std::string_view name) {
  return std::ranges::find(inherited_names, name) != inherited_names.end();
}

std::string namespace_of(std::string_view service) {
  std::vector<std::string> segments = segments_of(service);
  for (std::string& segment : segments) segment = pascal(segment);
  return join(segments, ".");
}

std::string qualified(const model::Definition& definition, std::string_view type) {
  return "global::" + namespace_of(definition.name) + "." + std::string(type);
}

std::string interface_name(const model::Object& object) { return "I" + pascal(code_name(object)); }
std::string stub_name(const model::Object& object) { return pascal(code_name(object)) + "Stub"; }
std::string skeleton_name(const model::Object& object) {
  return pascal(code_name(object)) + "Skeleton";
}
std::string default_name(const model::Object& object) {
  return pascal(code_name(object)) + "Default";
}

bool has_default(const model::Object& object) {
  return std::ranges::any_of(object.members, [](const model::Member& member) {
    return member.kind == model::MemberKind::property ||
           (member.kind == model::MemberKind::memory && runtime_abilities.serve(member));
  });
}

std::string member_name(std::string_view wire_name, std::string_view owner, Span span,
                        Report& report) {
  std::string name = pascal(wire_name);
  if (name != owner && !is_inherited_name(name)) return name;
  name += '_';
  report_renamed(wire_name, name, "C#", span, report);
  return name;
}

Names::Names(const model::Definition& definition, const model::Model& model, Report& report)
    : definition_(definition) {
  add_types(report);
  for (const auto& other : model.definitions()) hide(*other);
  const auto hide_members = [&](const auto& members) {
    for (const auto& member : members) members_.insert(pascal(code_name(member)));
  };
  for (const model::Record& record : definition.records) hide_members(record.fields);
  for (const model::Object& object : definition.objects) hide_members(object.members);
  hidden_.insert(members_.begin(), members_.end());
}

void Names::add_types(Report& report) {
  NameSet types(csharp_language, report);
  const auto path = [&](const auto& one) { return definition_.name + "." + one.name; };
  const auto add_all = [&](const auto& all, std::string_view what) {
    for (const auto& one : all) types.add(pascal(code_name(one)), one.span, what, path(one));
  };
  if (!definition_.constants.empty()) {
    types.add(std::string(constants_class), definition_.constants.front().span,
              "class of the constants", "");
  }
  add_all(definition_.exceptions, "exception");
  add_all(definition_.enums, "enum");
  for (const model::Record& record : definition_.records) {
    types.add(pascal(code_name(record)), record.span, model::name_of(record.kind), path(record));
  }
  for (const model::Object& object : definition_.objects) {
    types.add(interface_name(object), object.span, "interface", path(object));
    types.add(stub_name(object), object.span, "stub", path(object));
    types.add(skeleton_name(object), object.span, "skeleton", path(object));
    if (has_default(object)) {
      types.add(default_name(object), object.span, "default class", path(object));
    }
  }
}

/// All that a plain name could mean before a using directive is asked.
void Names::hide(const model::Definition& definition) {
  for (const std::string& segment : segments_of(definition.name)) hidden_.insert(pascal(segment));
  hidden_.insert(std::string(constants_class));
  const auto hide_all = [&](const auto& all) {
    for (const auto& one : all) hidden_.insert(pascal(code_name(one)));
  };
  hide_all(definition.exceptions);
  hide_all(definition.enums);
  hide_all(definition.records);
  for (const model::Object& object : definition.objects) {
    hidden_.insert(
        {interface_name(object), stub_name(object), skeleton_name(object), default_name(object)});
  }
}

std::string Names::type(const model::Definition& owner, std::string_view name) const {
  if (&owner == &definition_) return std::string(name);
  return qualified(owner, name);
}

std::string Names::type_in_expression(const model::Definition& owner, std::string_view name) const {
  return members_.contains(name) ? qualified(owner, name) : type(owner, name);
}

std::string Names::library(std::string_view space, std::string_view name) {
  if (hidden_.contains(name)) return "global::" + std::string(space) + "." + std::string(name);
  usings_.emplace(space);
  return std::string(name);
}

std::string Names::local(std::string_view name, std::set<std::string>& taken) {
  std::string result = as_variable(camel(name));
  while (!taken.insert(result).second) result += '_';
  return result;
}

}  // namespace robdef::csharp
