// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compiler/backends/backend.hpp"
#include "compiler/model/model.hpp"

namespace robdef {

/// Fills the fields of a language's view of a member that say the same in every language: what it
/// is called on the wire, its kind, its modifiers, whether it is served. A view may leave single
/// modifiers and the forms of an index out.
template <class View>
void describe_member(View& view, const model::Member& member, const Abilities& abilities) {
  using model::MemberKind;
  view.wire_name = member.name;
  view.kind = model::name_of(member.kind);
  view.is_property = member.kind == MemberKind::property;
  view.is_function = member.kind == MemberKind::function;
  view.is_event = member.kind == MemberKind::event;
  view.is_objref = member.kind == MemberKind::objref;
  view.is_pipe = member.kind == MemberKind::pipe;
  view.is_callback = member.kind == MemberKind::callback;
  view.is_wire = member.kind == MemberKind::wire;
  view.is_memory = member.kind == MemberKind::memory;
  view.is_served = abilities.serve(member);
  view.is_perclient = member.access.is_perclient;
  view.is_urgent = member.access.is_urgent;
  if constexpr (requires { view.is_readonly; }) view.is_readonly = member.access.is_readonly;
  if constexpr (requires { view.is_writeonly; }) view.is_writeonly = member.access.is_writeonly;
  if constexpr (requires { view.is_unreliable; }) view.is_unreliable = member.access.is_unreliable;
  if constexpr (requires { view.is_nolock; }) view.is_nolock = member.access.is_nolock;
  if constexpr (requires { view.is_nolockread; }) {
    view.is_nolockread = member.access.is_nolockread;
  }
  view.can_get = view.is_property && !member.access.is_writeonly;
  view.can_set = view.is_property && !member.access.is_readonly;
  view.robdef_type = member.type.text();
  if constexpr (requires { view.has_int32_index; }) {
    view.has_int32_index = member.index == model::IndexForm::int32;
    view.has_string_index = member.index == model::IndexForm::string;
  }
}

}  // namespace robdef
