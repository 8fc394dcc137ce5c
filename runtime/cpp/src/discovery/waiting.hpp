// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/cpp/src/channel/interruption.hpp"
#include "runtime/cpp/src/channel/time.hpp"

namespace rr::discovery {

/// Waits until `wake` is interrupted or the deadline has come. Throws rr::Error
/// (operation_cancelled) when the thread's own Interruption is.
void wait_for_either(const channel::Interruption& wake, channel::Time deadline);

}  // namespace rr::discovery
