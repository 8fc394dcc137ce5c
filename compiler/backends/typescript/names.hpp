// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>

#include "compiler/backends/name_set.hpp"
#include "compiler/diagnostics/report.hpp"
#include "compiler/model/model.hpp"
#include "compiler/model/rename.hpp"

/// Every TypeScript name in generated code is made here.
namespace robdef::typescript {

using model::code_name;

/// `moveTo` for `move_to`; `maxPoints` for `MAX_POINTS`: a name without small letters loses its
/// capitals first.
std::string camel(std::string_view name);
/// `getMoveTo` for `get` and `move_to`.
std::string prefixed(std::string_view verb, std::string_view name);
/// A word that names no variable or type.
bool is_reserved(std::string_view word);
/// A method that every object has, or that JavaScript would call by itself.
bool is_inherited_name(std::string_view name);

/// A type or constant as its module exports it: its own name, with `_` behind a reserved word.
std::string exported(std::string_view name);
/// Names of what is made for an object.
std::string stub_name(const model::Object& object);
std::string skeleton_name(const model::Object& object);
std::string service_name(const model::Object& object);
/// The constants of an object or record.
std::string constants_name(std::string_view owner);

/// `name` as a method, followed by `_` where each object has it already; then R0903 is reported.
std::string member_name(std::string_view wire_name, Span span, Report& report);

/// The names of one definition's module.
class Names {
 public:
  /// Takes all names of the definition. Reports R0901 for two that are one in TypeScript, and R0903
  /// for those that are changed.
  Names(const model::Definition& definition, Report& report);

  /// A name of this or another definition, as this one's module writes it.
  [[nodiscard]] std::string of(const model::Definition& owner, std::string_view name) const;
  /// By what this module calls another one.
  [[nodiscard]] const std::string& alias(const model::Definition& import) const;
  /// A type of JavaScript, by its name where that means nothing else in this module.
  [[nodiscard]] std::string global(std::string_view name) const;
  /// A parameter's name that is not in `taken`, where it is put.
  static std::string local(std::string_view name, std::set<std::string>& taken);

 private:
  void add_names(Report& report);
  void add_aliases();
  void add(NameSet& names, std::string_view name, Span span, std::string_view what,
           const std::string& path, Report& report);
  void add_made(NameSet& names, const std::string& name, Span span, std::string_view what,
                const std::string& path);

  const model::Definition& definition_;
  std::set<std::string, std::less<>> taken_;
  std::map<const model::Definition*, std::string> aliases_;
};

}  // namespace robdef::typescript
