// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

#include "runtime/cpp/src/channel/synchronization.hpp"

namespace rr::channel {

/// A thread that waits for an answer, on its stack. It sleeps on its state.
template <class Sync>
struct BasicWaiter {
  static constexpr std::uint32_t reader = 1;    ///< it has the connection's read turn
  static constexpr std::uint32_t answered = 2;  ///< it will be done in a moment
  static constexpr std::uint32_t done = 4;      ///< it may go, and its memory with it

  using Link = typename Sync::template Plain<BasicWaiter*>;

  // reader and answered are written under the connection's lock
  typename Sync::SleepWord state{0};
  Link next = nullptr;  // guarded by the connection

  [[nodiscard]] bool is_done() const { return (state.load(std::memory_order_acquire) & done) != 0; }
  [[nodiscard]] bool is_reader() const {
    return (state.load(std::memory_order_acquire) & reader) != 0;
  }
};

using Waiter = BasicWaiter<Synchronization>;

}  // namespace rr::channel
