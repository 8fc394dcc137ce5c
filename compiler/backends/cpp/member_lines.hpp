// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "compiler/backends/cpp/names.hpp"
#include "compiler/backends/cpp/view.hpp"

/// What a member's lines in templates need beside its types: names of further parameters, the types
/// of handles, and what its row in a table has.
namespace robdef::cpp {

/// Adds them to a view whose names, types and table entry are there already.
void make_forms(MemberView& view, const Names& names);

/// What the row of a member in its object's table has; `access` are its modifiers.
void make_row(MemberView& view, std::vector<std::string> access);

}  // namespace robdef::cpp
