// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/backends/matlab/names.hpp"
#include "compiler/backends/matlab/view.hpp"
#include "compiler/diagnostics/report.hpp"
#include "compiler/model/model.hpp"

/// The parts of making a view; view.cpp puts them together.
namespace robdef::matlab {

/// Documentation as the lines of a help text: the first behind the name, `%FRAME Sent at ...`, the
/// others indented behind their `%`. What is given as `title` stands for missing documentation.
struct Help {
  std::string title;
  std::vector<std::string> lines;
};
Help help(std::string_view name, const std::string& documentation, const std::string& title);
/// Lines with `% ` before each.
std::vector<std::string> comment(const std::string& documentation);

std::vector<ConstantView> make_constants(const std::vector<model::Constant>& constants,
                                         std::string_view owner);

ObjectView make_object(const model::Object& object, Report& report);

/// Adds the members of an object. Reports R0904 for those that the runtime cannot serve.
void make_members(ObjectView& view, const model::Object& object, Report& report);

}  // namespace robdef::matlab
