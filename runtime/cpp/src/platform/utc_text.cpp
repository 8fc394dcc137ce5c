// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdio>

#include "runtime/cpp/src/platform/clock.hpp"

namespace rr::platform {

// Not by functions of the C library: that of Windows knows no time before 1970.
std::tm utc(std::time_t time) {
  using namespace std::chrono;
  const sys_seconds point{seconds(time)};
  const sys_days day_begin = floor<days>(point);
  const year_month_day date(day_begin);
  const hh_mm_ss in_day(point - day_begin);
  std::tm parts{};
  parts.tm_year = static_cast<int>(date.year()) - 1900;
  parts.tm_mon = static_cast<int>(static_cast<unsigned>(date.month())) - 1;
  parts.tm_mday = static_cast<int>(static_cast<unsigned>(date.day()));
  parts.tm_hour = static_cast<int>(in_day.hours().count());
  parts.tm_min = static_cast<int>(in_day.minutes().count());
  parts.tm_sec = static_cast<int>(in_day.seconds().count());
  parts.tm_wday = static_cast<int>(weekday(day_begin).c_encoding());
  parts.tm_yday = static_cast<int>((day_begin - sys_days(date.year() / January / 1)).count());
  return parts;
}

std::chrono::system_clock::time_point time_of_utc(const std::tm& parts) {
  using namespace std::chrono;
  const year_month_day date(year(parts.tm_year + 1900),
                            month(static_cast<unsigned>(parts.tm_mon + 1)),
                            day(static_cast<unsigned>(parts.tm_mday)));
  const sys_seconds time =
      sys_days(date) + hours(parts.tm_hour) + minutes(parts.tm_min) + seconds(parts.tm_sec);
  using Point = system_clock::time_point;
  if (time > floor<seconds>(Point::max())) return Point::max();
  if (time < ceil<seconds>(Point::min())) return Point::min();
  return time;
}

std::string utc_text(std::chrono::system_clock::time_point time, unsigned decimals) {
  const auto since = std::chrono::floor<std::chrono::microseconds>(time.time_since_epoch());
  const auto seconds = std::chrono::floor<std::chrono::seconds>(since);
  const std::tm parts = utc(static_cast<std::time_t>(seconds.count()));
  std::array<char, 64> text{};
  std::size_t size = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%S", &parts);
  std::snprintf(text.data() + size, text.size() - size, ".%06d",
                static_cast<int>((since - seconds).count()));
  size += 1 + std::min(decimals, 6U);
  return std::string(text.data(), size) + "Z";
}

}  // namespace rr::platform
