// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "rr/visibility.hpp"

namespace rr::platform {

/// Random bytes of the system, which no peer foresees. At most 256. Throws std::system_error.
RR_INSIDE void fill_random(std::span<std::byte> bytes);

/// A generator for distributions of the standard library: each number is the system's.
/// std::random_device asks the processor for its abilities each time that one is made, which takes
/// 100 us in a virtual machine.
class RandomNumbers {
 public:
  using result_type = std::uint32_t;

  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }

  result_type operator()() const {
    result_type number = 0;
    fill_random(std::as_writable_bytes(std::span(&number, 1)));
    return number;
  }
};

}  // namespace rr::platform
