// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <string_view>

#include "compiler/backends/name_set.hpp"
#include "compiler/diagnostics/report.hpp"
#include "compiler/model/model.hpp"
#include "compiler/model/rename.hpp"

/// Every C# name in generated code is made here.
namespace robdef::csharp {

using model::code_name;

/// `MoveTo` for `move_to`; `MaxPoints` for `MAX_POINTS`: a name without small letters loses its
/// capitals first.
std::string pascal(std::string_view name);
/// `moveTo`, with `@` before it when that is a keyword.
std::string camel(std::string_view name);
/// A word of C# that needs `@` to be a name.
bool is_keyword(std::string_view word);
/// What every class has from `object`, or a record from the compiler.
bool is_inherited_name(std::string_view name);

/// `Experimental.Mount` for experimental.mount.
std::string namespace_of(std::string_view service);
/// `global::Experimental.Mount.Angles`
std::string qualified(const model::Definition& definition, std::string_view type);

/// Names of the types that are made for an object.
std::string interface_name(const model::Object& object);
std::string stub_name(const model::Object& object);
std::string skeleton_name(const model::Object& object);
std::string default_name(const model::Object& object);
/// Objects without properties and memories have nothing to store, and no Default class.
bool has_default(const model::Object& object);
/// The class that holds the constants of a definition.
inline constexpr std::string_view constants_class = "Constants";

/// `name`, followed by `_` where C# or the type around it, `owner`, has it already; then R0903
/// is reported.
std::string member_name(std::string_view wire_name, std::string_view owner, Span span,
                        Report& report);

/// The names of one definition's file.
class Names {
 public:
  /// Takes all names of the definition. Reports R0901 for two that are one in C#.
  Names(const model::Definition& definition, const model::Model& model, Report& report);

  [[nodiscard]] const model::Definition& definition() const { return definition_; }
  /// A type of this or another definition, as this one writes it.
  [[nodiscard]] std::string type(const model::Definition& owner, std::string_view name) const;
  /// The same where a value may stand too, which members of the class around it would hide.
  [[nodiscard]] std::string type_in_expression(const model::Definition& owner,
                                               std::string_view name) const;
  /// A type of a library, by its name where that means nothing else in this file.
  std::string library(std::string_view space, std::string_view name);
  /// The namespaces that library() relies on.
  [[nodiscard]] const std::set<std::string>& usings() const { return usings_; }
  /// A parameter's name that is not in `taken`, where it is put.
  static std::string local(std::string_view name, std::set<std::string>& taken);

 private:
  void add_types(Report& report);
  void hide(const model::Definition& definition);

  const model::Definition& definition_;
  std::set<std::string, std::less<>> hidden_;  // library types that must be qualified
  std::set<std::string, std::less<>> members_;
  std::set<std::string> usings_;
};

}  // namespace robdef::csharp
