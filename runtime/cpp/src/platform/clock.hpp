// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <ctime>
#include <string>

#include "rr/visibility.hpp"

namespace rr::platform {

using Time = std::chrono::steady_clock::time_point;

/// The steady clock to a few milliseconds, for a quarter of its price. On the same time line.
RR_INSIDE Time coarse_now();

/// The parts of a time in UTC.
RR_INSIDE std::tm utc(std::time_t time);
/// The other way round; the days of the week and the year are not looked at. What a time point
/// cannot hold, as a year after 2262, is the last or the first that it can.
RR_INSIDE std::chrono::system_clock::time_point time_of_utc(const std::tm& parts);

/// As RFC 3339 has it, with 1 to 6 decimals of the second: `2026-01-31T09:30:00.125Z`.
RR_INSIDE std::string utc_text(std::chrono::system_clock::time_point time, unsigned decimals);

}  // namespace rr::platform
