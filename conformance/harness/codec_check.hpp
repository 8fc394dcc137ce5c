// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "conformance/harness/captures.hpp"
#include "conformance/harness/result.hpp"
#include "conformance/harness/runner.hpp"

/// The roles without a connection: bytes to what they mean, and back.
namespace rr::conformance {

/// The bytes of each frame are given to the runner: its decode must be the recorded one.
Result check_decoding(const Scenario& scenario, Runner& decoder);
/// What each frame means is given to the runner: its bytes must be the recorded ones.
Result check_encoding(const Scenario& scenario, Runner& encoder);

/// Each recorded element of this message version must unpack to its value.
Result check_unpacking(const Captures& captures, int message_version, Runner& decoder);
/// Each value must be packed, from its type and value alone, to the recorded element; and the
/// element must come back byte for byte from its own decode.
Result check_packing(const Captures& captures, int message_version, Runner& decoder,
                     Runner& encoder);

}  // namespace rr::conformance
