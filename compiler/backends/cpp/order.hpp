// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "compiler/model/model.hpp"

namespace robdef::cpp {

/// The declarations of a definition in its own order, moved forward only where C++ needs a complete
/// type: a record before the records and objects that use it, an object before those that implement
/// it.
std::vector<model::Declaration> in_cpp_order(const model::Definition& definition);

/// Records and objects of the definition that are named before they are defined in that order.
std::vector<model::Declaration> named_early(const std::vector<model::Declaration>& order);

}  // namespace robdef::cpp
