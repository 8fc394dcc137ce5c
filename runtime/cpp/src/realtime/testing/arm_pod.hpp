// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "rr/realtime/layout.hpp"

namespace rr::realtime::testing {

/// A pod with gaps, as a program without generated code would declare it.
struct ArmPod {
  std::uint8_t mode = 0;
  std::array<double, 6> q{};
  bool has_fault = false;
  std::int16_t temperature = 0;
  std::uint64_t sample = 0;

  bool operator==(const ArmPod&) const = default;
};

inline Layout arm_layout() {
  static constexpr std::array entries{
      SignalEntry{"mode", SignalType::uint8, 1, offsetof(ArmPod, mode)},
      SignalEntry{"q", SignalType::double_, 6, offsetof(ArmPod, q)},
      SignalEntry{"has_fault", SignalType::bool_, 1, offsetof(ArmPod, has_fault)},
      SignalEntry{"temperature", SignalType::int16, 1, offsetof(ArmPod, temperature)},
      SignalEntry{"sample", SignalType::uint64, 1, offsetof(ArmPod, sample)}};
  return Layout("experimental.arm.ArmPod", entries, sizeof(ArmPod));
}

}  // namespace rr::realtime::testing
