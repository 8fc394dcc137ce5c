// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "compiler/backends/csharp/names.hpp"
#include "compiler/backends/csharp/types.hpp"
#include "compiler/backends/csharp/view.hpp"
#include "compiler/diagnostics/report.hpp"
#include "compiler/model/model.hpp"

/// The parts of making a view; view.cpp puts them together.
namespace robdef::csharp {

inline constexpr std::size_t line_width = 120;
inline constexpr std::size_t in_class = 4;  ///< the indent of what is in a class

/// What is at hand while the view of one definition is made.
struct Context {
  Names& names;
  Types& types;
  Report& report;
};

/// Documentation as `///` lines of a summary, printed behind `indent` blanks; none for none.
std::vector<std::string> summary(const std::string& documentation, std::size_t indent);

/// The constants of a definition, record or object, for the inside of the class `owner`.
std::vector<ConstantView> make_constants(const std::vector<model::Constant>& constants,
                                         const std::string& owner, const Context& context,
                                         std::size_t indent);

ObjectView make_object(const model::Object& object, const Context& context);

/// Adds the members of an object and the rows of their table. Reports R0904 for those that the
/// runtime cannot serve, and R0901 for names that are made twice.
void make_members(ObjectView& view, const model::Object& object, const Context& context);

/// Reports R0902 for what C# cannot express; with one there is no view.
void check_types(const model::Definition& definition, Report& report);

}  // namespace robdef::csharp
