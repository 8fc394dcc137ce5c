// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/backends/cpp/types.hpp"
#include "compiler/model/model.hpp"

/// Constants and literals in C++.
namespace robdef::cpp {

/// `text` between quotes, with escapes.
std::string string_literal(std::string_view text);
/// Adds the type and value of a constant that is no struct constant.
void describe(ConstantFacts& facts, const model::Constant& constant, Types& types);
/// A struct constant called `name`, which becomes a struct whose members are its values.
std::vector<ConstantPartView> constant_parts(const model::Constant& constant,
                                             const std::string& name, Types& types);

}  // namespace robdef::cpp
