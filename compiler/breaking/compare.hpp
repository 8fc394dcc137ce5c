// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compiler/breaking/changes.hpp"
#include "compiler/model/model.hpp"

namespace robdef::breaking {

/// Compares two versions of service definitions, whose sources are in one Sources. What breaks
/// users of the old one goes into `changes`. The order of declarations, comments and blanks are no
/// change. Time and memory grow with the size of the definitions, whatever is in them.
///
/// `now_is_partial`: what the new side does not have may exist elsewhere, as with the definitions
/// that a running service sends.
void compare(const model::Model& before, const model::Model& now, bool now_is_partial,
             Changes& changes);

}  // namespace robdef::breaking
