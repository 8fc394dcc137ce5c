// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "compiler/backends/typescript/names.hpp"
#include "compiler/backends/typescript/types.hpp"
#include "compiler/backends/typescript/view.hpp"
#include "compiler/diagnostics/report.hpp"
#include "compiler/model/model.hpp"

/// The parts of making a view; view.cpp puts them together.
namespace robdef::typescript {

/// What is at hand while the view of one definition is made.
struct Context {
  const Names& names;
  const Types& types;
  Report& report;
};

/// Documentation as a comment, printed behind `indent` blanks; none for none.
std::vector<std::string> comment(const std::string& documentation, std::size_t indent);

/// The constants of a definition, record or object.
std::vector<ConstantView> make_constants(const std::vector<model::Constant>& constants,
                                         std::size_t indent, const std::string& owner,
                                         Report& report);

ObjectView make_object(const model::Object& object, const Context& context);

/// Adds the members of an object. Reports R0904 for those that the runtime cannot serve, and R0901
/// for names that are made twice.
void make_members(ObjectView& view, const model::Object& object, const Context& context);

}  // namespace robdef::typescript
