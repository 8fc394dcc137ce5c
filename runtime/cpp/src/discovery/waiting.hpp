// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/cpp/src/channel/interruption.hpp"
#include "runtime/cpp/src/channel/time.hpp"

namespace rr::discovery {

/// Waits until `wake` is interrupted or the deadline has come. Throws rr::Error
/// (operation_cancelled) when the thread's own Interruption is.
void wait_for_either(const channel::Interruption& wake, channel::Time deadline);

/// A pause of at least and at most so many milliseconds, so that nodes that hear the same do not
/// all ask at once.
channel::Milliseconds random_between(int least, int most);

}  // namespace rr::discovery
