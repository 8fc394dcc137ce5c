// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "compiler/backends/cpp/names.hpp"
#include "compiler/backends/cpp/view.hpp"

/// What a member's lines in templates need beside its types: names of further parameters, and the
/// types of handles. The rows of tables, laid out.
namespace robdef::cpp {

/// Adds them to a view whose names, types and table entry are there already.
void make_forms(MemberView& view, const Names& names);

/// What the row of a member in its object's table has. `access` as `::rr::readonly | ::rr::nolock`
/// or empty.
void make_row(MemberView& view, const std::string& access);

/// `rr_value_level`, `rr_memory_buffer`: what a Default class keeps.
std::string stored_name(const MemberView& view);

}  // namespace robdef::cpp
