// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <string_view>

#include "compiler/backends/name_set.hpp"
#include "compiler/diagnostics/report.hpp"
#include "compiler/model/model.hpp"
#include "compiler/model/rename.hpp"

/// Every MATLAB name in generated code is made here. Names are as in the definition; a word that
/// MATLAB or Octave keeps for itself gets a `_`.
namespace robdef::matlab {

inline constexpr std::string_view language = matlab_language.shown;

using model::code_name;

/// A word that no name may be, in MATLAB or in Octave.
bool is_keyword(std::string_view word);
/// What every object has from its base classes, or what has a meaning of its own in a class.
bool is_class_word(std::string_view word);
/// A function of MATLAB or Octave that hides a package of the same name.
bool is_function(std::string_view word);

/// The name itself, followed by `_` when it is a keyword.
std::string identifier(std::string_view name);
/// A type: not a keyword, nor a word that a file with a class cannot begin with.
std::string type_name(std::string_view name);
/// An exception: nor what its class has.
std::string exception_name(std::string_view name);
/// A member of the class `owner`: not a keyword, nor the constructor, nor what it has from its
/// bases.
std::string member_name(std::string_view name, std::string_view owner);

/// `experimental.mount`: the service's name, as far as packages may have it.
std::string package_of(std::string_view service);
/// `+experimental/+mount`
std::string folder_of(std::string_view service);
/// `experimental.mount.Angles`
std::string qualified(const model::Definition& definition, std::string_view name);
/// `experimental_mount_client`: the MEX file of what is generated together, named after the first
/// definition.
std::string client_of(const model::Model& model);

/// The class that holds the constants of a definition, and that of a record.
inline constexpr std::string_view constants_class = "Constants";
std::string constants_class_of(const model::Record& record);

/// A parameter's name that is not in `taken`, where it is put.
std::string local(std::string_view name, std::set<std::string>& taken);

/// Reports R0901 for two files of a definition that would be one, and for a type that is called
/// like a package; R0903 for names that had to be changed.
void check_names(const model::Definition& definition, const model::Model& model, Report& report);

}  // namespace robdef::matlab
