// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

/// What the calling thread asks of the system's scheduler. Each is a wish: where the system has
/// nothing of the kind, or refuses, the thread stays as it is.
namespace rr::platform {

/// Not to take the processor from the thread that wakes this one: it runs when that one pauses.
void prefer_throughput();
/// To get the processor soon, and to give it back soon.
void ask_for_short_slices();
/// To come after the process's other threads, but before nothing at all.
void lower_priority();
/// Signals are delivered to other threads of the process.
void leave_signals_to_others();

/// Runs this on a new thread, which nobody joins. Throws std::system_error when there is none.
/// Instead of std::thread::detach(): winpthreads may give what it keeps of a thread to two others
/// when the thread ends while it is detached.
void run_apart(std::function<void()> work);

}  // namespace rr::platform
