// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <utility>

#include "runtime/cpp/src/channel/time.hpp"

namespace rr::channel {

/// How fast messages come on one connection, and how long they keep the reactor's thread. Written
/// by whoever has the read lease.
class ReceivePace {
 public:
  /// After a receive: whether messages have come close after each other for a while, in which no
  /// caller has read: it would have to follow. Asked again, only after another while.
  /// `uses`: those of the read lease.
  bool is_busy(Time last_received, Time received, std::uint32_t uses) {
    constexpr Milliseconds close{8};  // the clock has steps of 4 ms
    constexpr unsigned while_of_receives = 64;
    const bool is_close = received - last_received < close;
    const bool is_lone = std::exchange(seen_uses_, uses) == uses;
    receives_ = is_close && is_lone ? receives_ + 1 : 0;
    if (receives_ < while_of_receives) return false;
    receives_ = 0;
    return true;
  }

  /// A connection that has kept the polling thread for so long, twice in a row, does not go before
  /// others next time. Once may be the system's doing, which has given the processor to others.
  void note_read(Clock::duration time) {
    const int before = long_reads_.load(std::memory_order_relaxed);
    const int now = time > long_time ? std::min(before + 1, int{many_long_reads}) : 0;
    long_reads_.store(static_cast<std::uint8_t>(now), std::memory_order_relaxed);
  }
  /// There was more than may be read at once.
  void note_endless() { long_reads_.store(many_long_reads, std::memory_order_relaxed); }
  /// Any thread.
  [[nodiscard]] bool takes_long() const {
    return long_reads_.load(std::memory_order_relaxed) >= many_long_reads;
  }

  /// A sender that has one segment under way at a time, as small devices do, gets a late
  /// acknowledgement after 40 ms, right after this side has asked for late ones: it is not to be
  /// made to wait again.
  void look_for_waiting_sender(Time before, Time received) {
    const auto pause = received - before;
    if (pause >= Milliseconds(36) && pause < Milliseconds(64)) acknowledges_late_ = false;
  }
  [[nodiscard]] bool acknowledges_late() const { return acknowledges_late_; }

 private:
  static constexpr std::chrono::microseconds long_time{100};
  static constexpr std::uint8_t many_long_reads = 2;

  std::atomic<std::uint8_t> long_reads_{0};  // in a row
  bool acknowledges_late_ = true;
  unsigned receives_ = 0;
  std::uint32_t seen_uses_ = 0;
};

}  // namespace rr::channel
