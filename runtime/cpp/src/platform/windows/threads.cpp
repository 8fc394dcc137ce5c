// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/threads.hpp"

#include <windows.h>

namespace rr::platform {

// Windows has nothing of the kind for a thread of its own.
void prefer_throughput() {}
void ask_for_short_slices() {}

void lower_priority() { SetThreadPriority(GetCurrentThread(), THREAD_PRIORITY_BELOW_NORMAL); }

// Console events have threads of their own.
void leave_signals_to_others() {}

}  // namespace rr::platform
