// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "compiler/syntax/ast.hpp"

namespace robdef::syntax {

/// Before it, versions were declared by `option version`.
inline constexpr ast::Version first_with_stdver{{0, 9, 0, 0}};
/// From it on a `stdver` line forbids `option` and `end KIND`.
inline constexpr ast::Version first_without_options{{0, 9, 2, 0}};
/// The newest version whose rules are known.
inline constexpr ast::Version newest_known{{1, 2, 8, 0}};

/// Two numbers, or as many as are needed.
std::string text_of(const ast::Version& version);

}  // namespace robdef::syntax
