// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "conformance/runners/shared/adapters.hpp"

namespace rr::conformance {

/// Adds everything that was generated for the definitions of the captures. Written by the build.
void add_all(Adapters& adapters);

}  // namespace rr::conformance
