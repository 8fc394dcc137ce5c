// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "conformance/harness/captures.hpp"
#include "conformance/harness/comparison.hpp"
#include "conformance/harness/json.hpp"

/// What a recording says of the service that was recorded.
namespace rr::conformance {

/// What a runner's `serve` is told so that it is the service of a recording. `channel` is what its
/// node needs for it, null for TCP.
Json serve_request(const Captures& captures, const Scenario& scenario, const Json& channel = {});

/// The service that a connection is with, as its first requests say.
std::string service_of(const Scenario& scenario, int connection);

/// The name that the host language of the recorded library gave to the exception in an answer.
std::string host_error_of(const Frame& frame, const Comparison& comparison);

}  // namespace rr::conformance
