// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "conformance/harness/result.hpp"
#include "conformance/harness/service_replay.hpp"

namespace rr::conformance {

/// Sends the broken inputs of one message version to a service, each on a connection of its own.
/// The answer must be of the recorded class; after each, and beside those that get no answer,
/// another connection must be served.
Result check_malformed(const Captures& captures, int message_version, const Deviations& deviations,
                       const Connect& connect_new);

}  // namespace rr::conformance
