// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <utility>

#include "runtime/cpp/src/channel/scratch.hpp"
#include "runtime/cpp/src/channel/strand.hpp"
#include "runtime/cpp/src/channel/time.hpp"

namespace rr::channel {

/// A thread's part in a strand, on its stack. The messages that it has read and not handled yet are
/// in the scratch.
class StrandTurn {
 public:
  /// `longest`: it lets others go first after this time.
  StrandTurn(const Strand& strand, Scratch& scratch, std::chrono::microseconds longest);
  ~StrandTurn();
  StrandTurn(const StrandTurn&) = delete;
  StrandTurn& operator=(const StrandTurn&) = delete;
  /// The calling thread's in a strand; null when it has none, or not as its innermost.
  static StrandTurn* current(const Strand& strand) {
    return innermost != nullptr && innermost->strand_ == &strand ? innermost : nullptr;
  }

  [[nodiscard]] Scratch& scratch() { return scratch_; }
  /// The message that is handled now is to be handled again; by this thread.
  [[nodiscard]] bool is_put_off() const { return is_put_off_; }
  void set_put_off(bool is_put_off) { is_put_off_ = is_put_off; }
  [[nodiscard]] bool has_next() const { return next_ < scratch_.waiting.size(); }
  Frame next() { return std::move(scratch_.waiting[next_++]); }
  /// The last of those that are still to come.
  Frame take_last() {
    Frame frame = std::move(scratch_.waiting.back());
    scratch_.waiting.pop_back();
    return frame;
  }
  /// False while the thread is outside; changed under the connection's lock, by this thread.
  [[nodiscard]] bool is_held() const { return is_held_; }
  void set_held(bool is_held) { is_held_ = is_held; }
  /// Whether it is time to let others go first. Asked between messages, from the first one on.
  [[nodiscard]] bool is_over() {
    if (unasked_ != 0) {
      --unasked_;
      return false;
    }
    const Time now = Clock::now();
    if (until_ == Time::min()) until_ = now + longest_;
    // Short messages cost hardly more than the clock.
    if (now - asked_ < quick) unasked_ = most_unasked;
    asked_ = now;
    return now >= until_;
  }
  /// Nobody else waits.
  void go_on() {
    until_ = asked_ + longest_;
    has_gone_on_ = true;
  }
  /// Whether it has since this was asked last.
  bool has_gone_on() { return std::exchange(has_gone_on_, false); }
  void count(std::size_t requests) { requests_ += requests; }
  /// Whether a few requests have taken a tick of the coarse clock.
  [[nodiscard]] bool is_slow() const { return requests_ < many_requests && coarse_now() != begin_; }

 private:
  static constinit thread_local StrandTurn* innermost;

  const Strand* const strand_;
  Scratch& scratch_;
  const std::chrono::microseconds longest_;
  std::size_t next_ = 0;
  bool is_held_ = true;
  bool is_put_off_ = false;
  static constexpr std::size_t many_requests = 16;
  const Time begin_ = coarse_now();
  static constexpr std::chrono::microseconds quick{8};
  static constexpr int most_unasked = 7;
  Time until_ = Time::min();
  Time asked_{};
  int unasked_ = 0;
  bool has_gone_on_ = false;
  std::size_t requests_ = 0;
  StrandTurn* const outer_;
};

}  // namespace rr::channel
