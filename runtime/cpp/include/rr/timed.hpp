// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "rr/time_spec.hpp"
#include "rr/visibility.hpp"

namespace RR_VISIBLE rr {

/// A value and the moment it was sent, by the sender's clock.
template <class T>
struct Timed {
  T value{};        ///< as it was sent
  TimeSpec time{};  ///< when it was sent
};

}  // namespace rr
