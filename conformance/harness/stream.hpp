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

}  // namespace rr::conformance
