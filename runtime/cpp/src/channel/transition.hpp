// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cassert>
#include <span>

namespace rr::channel {

/// One row of a table of states: what changes one into another.
template <class State>
struct Transition {
  State from;
  const char* by;  ///< functions, as docs/architecture.md names them
  State to;
};

/// Changes a state. A debug build ends at a change that the table does not have.
template <class State>
void change(State& state, State to, [[maybe_unused]] std::span<const Transition<State>> table) {
  assert(state == to || std::ranges::any_of(table, [&](const Transition<State>& row) {
           return row.from == state && row.to == to;
         }));
  state = to;
}

}  // namespace rr::channel
