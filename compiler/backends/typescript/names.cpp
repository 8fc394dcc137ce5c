// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/typescript/names.hpp"

#include <algorithm>
#include <array>

#include "compiler/backends/words.hpp"

namespace robdef::typescript {
namespace {

// Words of JavaScript in modules, names of types that TypeScript has built in, names that it keeps
// for CommonJS, and what generated code calls the runtime.
constexpr auto reserved = std::to_array<std::string_view>(
    {"Object",     "any",       "arguments",  "as",        "asserts",    "async",     "await",
     "bigint",     "boolean",   "break",      "case",      "catch",      "class",     "const",
     "continue",   "debugger",  "declare",    "default",   "delete",     "do",        "else",
     "enum",       "eval",      "export",     "exports",   "extends",    "false",     "finally",
     "for",        "function",  "globalThis", "if",        "implements", "import",    "in",
     "instanceof", "interface", "intrinsic",  "let",       "module",     "never",     "new",
     "null",       "number",    "object",     "package",   "private",    "protected", "public",
     "require",    "return",    "rr",         "satisfies", "static",     "string",    "super",
     "switch",     "symbol",    "this",       "throw",     "true",       "try",       "type",
     "typeof",     "undefined", "unknown",    "using",     "var",        "void",      "while",
     "with",       "yield"});

constexpr auto inherited_names = std::to_array<std::string_view>(
    {"constructor", "hasOwnProperty", "isPrototypeOf", "new", "propertyIsEnumerable", "then",
     "toLocaleString", "toString", "valueOf"});

// Where functions of generated code use another module, these are their own.
constexpr auto locals = std::to_array<std::string_view>({"index", "options", "servant", "value"});

bool has(const auto& words, std::string_view word) {
  return std::ranges::find(words, word) != words.end();
}

}  // namespace

std::string camel(std::string_view name) { return camel_case(without_capitals(name)); }

std::string prefixed(std::string_view verb, std::string_view name) {
  return std::string(verb) + pascal_case(without_capitals(name));
}

bool is_reserved(std::string_view word) { return has(reserved, word); }

bool is_inherited_name(std::string_view name) { return has(inherited_names, name); }

std::string exported(std::string_view name) {
  return std::string(name) + (is_reserved(name) ? "_" : "");
}

std::string stub_name(const model::Object& object) { return code_name(object) + "Stub"; }
std::string skeleton_name(const model::Object& object) { return code_name(object) + "Skeleton"; }
std::string service_name(const model::Object& object) { return code_name(object) + "Service"; }
std::string constants_name(std::string_view owner) { return std::string(owner) + "Constants"; }

std::string member_name(std::string_view wire_name, Span span, Report& report) {
  std::string name = camel(wire_name);
  if (!is_inherited_name(name)) return name;
  name += '_';
  report_renamed(wire_name, name, "TypeScript", span, report);
  return name;
}

Names::Names(const model::Definition& definition, Report& report) : definition_(definition) {
  add_names(report);
  add_aliases();
}

void Names::add(NameSet& names, std::string_view name, Span span, std::string_view what,
                const std::string& path, Report& report) {
  const std::string result = exported(name);
  if (result != name) report_renamed(name, result, "TypeScript", span, report);
  add_made(names, result, span, what, path);
}

void Names::add_made(NameSet& names, const std::string& name, Span span, std::string_view what,
                     const std::string& path) {
  names.add(name, span, what, path);
  taken_.insert(name);
}

void Names::add_names(Report& report) {
  NameSet names(typescript_language, report);
  const auto path = [&](const auto& one) { return definition_.name + "." + one.name; };
  const auto add_all = [&](const auto& all, std::string_view what) {
    for (const auto& one : all) {
      add(names, code_name(one), one.span, what, path(one), report);
    }
  };
  add_all(definition_.constants, "constant");
  add_all(definition_.exceptions, "exception");
  add_all(definition_.enums, "enum");
  const auto add_constants = [&](const auto& owner) {
    if (owner.constants.empty()) return;
    add_made(names, constants_name(code_name(owner)), owner.span, "constants", path(owner));
  };
  for (const model::Record& record : definition_.records) {
    add(names, code_name(record), record.span, model::name_of(record.kind), path(record), report);
    add_constants(record);
  }
  for (const model::Object& object : definition_.objects) {
    add(names, code_name(object), object.span, "interface", path(object), report);
    add_made(names, stub_name(object), object.span, "stub", path(object));
    add_made(names, service_name(object), object.span, "interface of services", path(object));
    add_made(names, skeleton_name(object), object.span, "skeleton", path(object));
    add_constants(object);
  }
}

void Names::add_aliases() {
  const auto is_free = [&](const std::string& name) {
    return !taken_.contains(name) && !is_reserved(name) && !has(locals, name);
  };
  for (const model::Definition* import : definition_.imports) {
    const std::vector<std::string> segments = segments_of(import->name);
    std::string alias = camel(segments.back());
    if (!is_free(alias)) alias = join(segments, "_");
    while (!is_free(alias)) alias += '_';
    taken_.insert(alias);
    aliases_.emplace(import, alias);
  }
}

const std::string& Names::alias(const model::Definition& import) const {
  return aliases_.at(&import);
}

std::string Names::of(const model::Definition& owner, std::string_view name) const {
  if (&owner == &definition_) return std::string(name);
  return alias(owner) + "." + std::string(name);
}

std::string Names::global(std::string_view name) const {
  return (taken_.contains(name) ? "globalThis." : "") + std::string(name);
}

std::string Names::local(std::string_view name, std::set<std::string>& taken) {
  std::string result = as_variable(camel(name));
  if (is_reserved(result)) result += '_';
  while (!taken.insert(result).second) result += '_';
  return result;
}

}  // namespace robdef::typescript
