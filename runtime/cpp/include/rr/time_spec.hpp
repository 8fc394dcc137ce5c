// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "rr/type.hpp"
#include "rr/visibility.hpp"

namespace RR_VISIBLE rr {

/// The one struct that every node knows without a definition: time since 1970-01-01 UTC (03,
/// section 6).
struct TimeSpec {
  std::int64_t seconds = 0;      ///< negative before 1970
  std::int32_t nanoseconds = 0;  ///< 0 <= nanoseconds < 1e9

  /// Whether both are the same moment.
  bool operator==(const TimeSpec&) const = default;
};
/// How it travels: the struct `RobotRaconteur.TimeSpec`.
extern const RecordType time_spec_type;
/// A struct that may not be null.
template <>
inline constexpr const Type& type_of<TimeSpec> = time_spec_type;

}  // namespace rr
