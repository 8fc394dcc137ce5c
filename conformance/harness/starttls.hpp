// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "conformance/harness/captures.hpp"
#include "conformance/harness/stream.hpp"

/// How the protocol changes over to TLS (04, section 6). All of it throws std::runtime_error when
/// the other side does something else.
namespace rr::conformance {

/// Asks for TLS, as a client with a certificate does.
void ask_for_tls(Stream& stream, const Scenario& scenario);

/// Waits for the request, and answers it as the node that is asked for, or as that of the scenario.
/// Returns which one that is; `is_mutual` says whether the client has a certificate.
Node answer_for_tls(Stream& stream, const Scenario& scenario, bool& is_mutual);

}  // namespace rr::conformance
