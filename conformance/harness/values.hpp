// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "conformance/harness/json.hpp"

namespace rr::conformance {

/// True when `got` is the value that `recorded` is, in the notation of the captures. What the
/// protocol does not carry is no difference: a varvalue of one number arrives as an array of one, a
/// typed container in a varvalue as one of varvalues; maps have no order; a single of the shortest
/// decimal is the same as the double it widens to; one number may stand for a list of one.
bool same_value(const Json& recorded, const Json& got);

/// True when the lists have the same things, whatever their order.
bool same_things(const Json& recorded, const Json& got);

/// A value as a finding shows it, at most so many bytes of it.
std::string said(const Json& json, std::size_t limit = 300);

}  // namespace rr::conformance
