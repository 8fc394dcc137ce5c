// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rr/options.hpp>

#include "conformance/harness/json.hpp"

namespace rr::conformance {

/// The node that a `start` request asks for. Throws std::runtime_error for what has no meaning.
NodeOptions node_options(const Json& request);

}  // namespace rr::conformance
