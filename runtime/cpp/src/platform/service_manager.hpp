// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string_view>

#include "rr/visibility.hpp"

namespace rr::platform {

/// Sends lines (`READY=1`) to the service manager that has started the process: a datagram to the
/// local socket that NOTIFY_SOCKET names. False where there is none, or it is not taken.
RR_INSIDE bool notify_service_manager(std::string_view lines);

/// How often the service manager wants to hear `WATCHDOG=1` at least; zero: not at all, or it is
/// another process that is meant.
RR_INSIDE std::chrono::microseconds watchdog_period();

/// Whether what is written to standard error goes to systemd's journal, which takes the priority
/// of a line from its beginning (`<4>`).
RR_INSIDE bool is_stderr_the_journal();

}  // namespace rr::platform
