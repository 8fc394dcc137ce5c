// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "conformance/harness/hex.hpp"
#include "runtime/cpp/src/replay/stream.hpp"

/// The connections over which the suite plays.
namespace rr::conformance {

using replay::Arrival;
using replay::Descriptor;
using replay::Listener;
using replay::Milliseconds;
using replay::Stream;
using replay::wait_readable;

/// How long an answer is waited for; and once something went otherwise than recorded.
inline constexpr Milliseconds answer_limit{3000};
inline constexpr Milliseconds limit_after_fault{100};

}  // namespace rr::conformance
