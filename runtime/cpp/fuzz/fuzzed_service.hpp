// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "rr/skeleton.hpp"

namespace rr::fuzz {

/// The root object of a service of fuzzed.robdef, in the state of a new one. It and all objects
/// below it share `life` while they exist.
std::shared_ptr<Skeleton> make_fuzzed_root(std::shared_ptr<const void> life);

}  // namespace rr::fuzz
