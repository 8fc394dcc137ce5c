// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ctime>

#include "runtime/cpp/sim/scheduler.hpp"

namespace rr::sim {

/// What a clock of the system shows at a time of the run.
timespec shown_by(clockid_t clock, Nanoseconds now);
/// The time of the run at which a clock shows this.
Nanoseconds time_of(clockid_t clock, const timespec& shown);
/// As nanoseconds, without overflow.
Nanoseconds length_of(const timespec& length);

}  // namespace rr::sim
