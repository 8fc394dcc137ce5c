// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rr/node.hpp>
#include <rr/options.hpp>

#include "conformance/harness/json.hpp"

namespace rr::conformance {

/// The node that a `start` request asks for. Throws std::runtime_error for what has no meaning.
NodeOptions node_options(const Json& request);

/// Listens as a `start` request asks: at a port of TCP, which is returned, or by another channel.
int listen(Node& node, const Json& request);

}  // namespace rr::conformance
