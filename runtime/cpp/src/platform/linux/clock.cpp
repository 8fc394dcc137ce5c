// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/clock.hpp"

namespace rr::platform {

Time coarse_now() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC_COARSE, &time);
  return Time(std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec));
}

}  // namespace rr::platform
