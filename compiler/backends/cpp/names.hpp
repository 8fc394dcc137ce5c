// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/backends/name_set.hpp"
#include "compiler/diagnostics/report.hpp"
#include "compiler/model/model.hpp"
#include "compiler/model/rename.hpp"

/// Every C++ name in generated code is made here.
namespace robdef::cpp {

using model::code_name;

/// A word of C++, one of its alternative tokens, or a macro of a standard header.
bool is_reserved(std::string_view word);
/// Something of the global namespace, where services may not have a namespace of the same name.
bool is_global_name(std::string_view word);
/// The name itself, followed by `_` when it is reserved.
std::string identifier(std::string_view name);

/// `experimental::mount` for experimental.mount.
std::string namespace_of(std::string_view service);
/// `experimental/mount`
std::string path_of(std::string_view service);
/// `::experimental::mount::Angles`
std::string qualified(const model::Definition& definition, std::string_view identifier);

/// Names of the classes that are made for an object.
std::string stub_name(const model::Object& object);
std::string skeleton_name(const model::Object& object);
std::string default_name(const model::Object& object);
/// Where a service has nothing to implement there is no Default class.
bool has_default(const model::Object& object);

/// `rr_type_Angles` and so on: what generated code defines besides the user's names. The word
/// behind `rr_` says what it is, so that no two names can meet.
std::string table_name(std::string_view what, std::string_view name);

/// The names of one definition's namespace, and how they are seen from inside its classes.
class Names {
 public:
  /// Takes all names of the definition. Reports R0901 for two that are one in C++, and R0903 for
  /// those that had to be changed.
  Names(const model::Definition& definition, const model::Model& model, Report& report);

  [[nodiscard]] const model::Definition& definition() const { return *definition_; }

  /// A type as it is written in this definition's namespace: by its own name, by an alias of
  /// `using`, or with its whole path. `hidden` are names of the class around it.
  [[nodiscard]] std::string type(const model::Record& record,
                                 const std::set<std::string>& hidden) const;
  [[nodiscard]] std::string type(const model::Enum& enumeration,
                                 const std::set<std::string>& hidden) const;
  /// A class that belongs to an object: `suffix` is Stub or Skeleton.
  [[nodiscard]] std::string object_class(const model::Object& object, std::string_view class_name,
                                         const std::set<std::string>& hidden) const;

  /// Whether a constant or alias of the namespace has this C++ name.
  [[nodiscard]] bool is_variable(std::string_view name) const;

  /// A parameter or local variable: changed where it would hide a name of the namespace, is
  /// reserved, begins like ours, or is taken; then it is taken.
  [[nodiscard]] std::string local(std::string_view name, std::set<std::string>& taken) const;

 private:
  struct Taken {
    Span span;
    std::string path;  ///< of what has the name; empty: an alias
  };

  void add_declarations(NameSet& names, Report& report);
  void check_inner_namespaces(const model::Model& model, Report& report);
  /// `wire_name` is that of the definition, `name` that in C++.
  [[nodiscard]] std::string type_of(const model::Definition& definition,
                                    const std::string& wire_name, const std::string& name,
                                    const std::set<std::string>& hidden) const;

  const model::Definition* definition_;
  std::map<std::string, Taken, std::less<>> taken_;
  std::map<std::string, std::string, std::less<>> aliases_;  ///< by qualified robdef name
};

/// Names of the fields and constants of a record. Reports R0901 and R0903.
class RecordNames {
 public:
  RecordNames(const model::Record& record, Report& report);
  /// Of a field or constant.
  [[nodiscard]] const std::string& of(std::string_view name) const;
  /// All of them: what types inside must not be mistaken for.
  [[nodiscard]] const std::set<std::string>& hidden() const { return hidden_; }

 private:
  std::map<std::string, std::string, std::less<>> names_;
  std::set<std::string> hidden_;
};

/// A member's name in the classes of its object: members named like one of them get a `_` too.
std::string member_name(const model::Object& object, const model::Member& member);
/// Names that members of the object and of all that it implements have inside its classes.
std::set<std::string> names_inside(const model::Object& object);
/// Reports R0901 and R0903 for the members and constants of an object.
void check_members(const model::Object& object, Report& report);

}  // namespace robdef::cpp
