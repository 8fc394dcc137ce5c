// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "compiler/backends/cpp/names.hpp"
#include "compiler/backends/cpp/view.hpp"

/// What the classes of an object contain for its members, laid out: one function for each kind.
/// Each takes a view whose names, types and table entry are there already, and adds the lines.
namespace robdef::cpp {

void lay_out_property(MemberView& view, const Names& names);
/// A function without generators.
void lay_out_function(MemberView& view, const Names& names);
void lay_out_generator(MemberView& view, const Names& names);
void lay_out_event(MemberView& view);
/// `stub_class` is the class around it.
void lay_out_objref(MemberView& view, const Names& names, const std::string& stub_class);
void lay_out_pipe(MemberView& view);
void lay_out_callback(MemberView& view, const Names& names);
void lay_out_wire(MemberView& view);
void lay_out_memory(MemberView& view);

/// The row of a member in its object's table. `object_tables` is the struct with the tables of
/// parameters, `access` as `::rr::readonly | ::rr::nolock` or empty.
std::string member_row(const MemberView& view, const std::string& object_tables,
                       const std::string& access);
/// The table of its parameters.
std::string parameter_table(const MemberView& view);

/// `rr_value_level`, `rr_memory_buffer`: what a Default class keeps.
std::string stored_name(const MemberView& view);

}  // namespace robdef::cpp
