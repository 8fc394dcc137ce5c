// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/service_manager.hpp"

namespace rr::platform {

// Windows has a service manager of another kind, which speaks first.
bool notify_service_manager(std::string_view /*lines*/) { return false; }
std::chrono::microseconds watchdog_period() { return {}; }
bool is_stderr_the_journal() { return false; }

}  // namespace rr::platform
