// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "compiler/backends/cpp/names.hpp"
#include "compiler/backends/cpp/types.hpp"
#include "compiler/backends/cpp/view.hpp"
#include "compiler/diagnostics/report.hpp"
#include "compiler/model/model.hpp"

/// The parts of making a view; view.cpp puts them together.
namespace robdef::cpp {

/// What is at hand while the view of one definition is made.
struct Context {
  const Names& names;
  Types& types;
  Report& report;
};

inline constexpr std::size_t class_indent = 2;  ///< of what is in a class

/// Documentation as `///` lines that are printed behind `indent` blanks.
std::vector<std::string> doc_lines(const std::string& documentation, std::size_t indent);

/// A constant of a definition or, `in_class`, of a record or object.
ConstantView make_constant(const model::Constant& constant, bool in_class, const Context& context);
/// The constants of a record or object, for the inside of a class.
std::vector<ConstantView> class_constants(const std::vector<model::Constant>& constants,
                                          const Context& context);

EnumView make_enum(const model::Enum& enumeration, const Context& context);
ExceptionView make_exception(const model::Exception& exception, const Context& context);
RecordView make_record(const model::Record& record, const Context& context);
ObjectView make_object(const model::Object& object, const Context& context);

/// Adds the members of an object and the rows of their table. Reports R0904 for those that the
/// runtime cannot serve.
void make_members(ObjectView& view, const model::Object& object, const Context& context);

/// Reports R0902 for types that C++ cannot express; a member or field with one makes no view.
void check_types(const model::Definition& definition, Report& report);

}  // namespace robdef::cpp
