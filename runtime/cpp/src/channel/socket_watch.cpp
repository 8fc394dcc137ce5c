// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/socket_watch.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace rr::channel {

std::span<const Transition<SocketWatch::State>> SocketWatch::transitions() {
  using enum State;
  static constexpr std::array<Transition<State>, 6> rows = {{
      {off, "begin", full},
      {off, "begin", idle},
      {full, "go_idle, pin", idle},
      {idle, "go_full, end_call, look", full},
      {full, "end", off},
      {idle, "end", off},
  }};
  return rows;
}

void SocketWatch::become(State state, bool has_unsent) {
  change(state_, state, transitions());
  watch(has_unsent);
}

// What the reactor is to tell of.
std::uint32_t SocketWatch::wanted(bool has_unsent) const {
  if (state_ == State::off) return 0;
  const bool is_full = state_ == State::full;
  if (is_bell_) return is_full || has_unsent ? ready::input | ready::closing : ready::closing;
  if (is_full) return ready::input | ready::room | ready::closing;
  return has_unsent ? ready::room : 0;
}

void SocketWatch::watch(bool has_unsent) {
  const std::uint32_t events = wanted(has_unsent);
  if (events == 0) {
    // Cheaper for the kernel than watching for nothing.
    if (is_registered_) watcher_.remove(socket_);
  } else if (is_registered_) {
    watcher_.change(socket_, events, pollable_);
  } else {
    watcher_.add(socket_, events, pollable_);
  }
  is_registered_ = events != 0;
}

void SocketWatch::begin(bool is_idle, bool has_unsent) {
  become(is_idle ? State::idle : State::full, has_unsent);
}

void SocketWatch::use_bell(bool has_unsent) {
  is_bell_ = true;
  watch(has_unsent);
}

void SocketWatch::end() {
  if (state_ != State::off) become(State::off, false);
}

void SocketWatch::go_idle(bool has_unsent) {
  if (state_ == State::full) become(State::idle, has_unsent);
}

void SocketWatch::go_full(bool has_unsent) {
  if (state_ == State::idle) become(State::full, has_unsent);
}

void SocketWatch::update(bool has_unsent) {
  if (state_ == State::idle) become(State::idle, has_unsent);
}

bool SocketWatch::end_call(Time last_received, std::uint32_t uses, bool has_more, bool has_unsent) {
  const bool is_tight = std::exchange(last_call_, last_received) == last_received || is_looked_at_;
  if (!has_more && is_tight) return must_look(uses);
  go_full(has_unsent);
  return false;
}

bool SocketWatch::pin(std::uint32_t uses, bool has_unsent) {
  is_pinned_ = true;
  go_idle(has_unsent);
  return must_look(uses);
}

// True when nobody has been told so yet.
bool SocketWatch::must_look(std::uint32_t uses) {
  if (std::exchange(is_looked_at_, true)) return false;
  seen_uses_ = uses;
  period_ = first_period;
  return true;
}

SocketWatch::Look SocketWatch::look(std::uint32_t uses, bool is_read, bool has_unsent) {
  const bool is_quiet = std::exchange(seen_uses_, uses) == uses;
  if (!is_quiet || (is_pinned_ && is_read)) {
    period_ = std::min<std::uint8_t>(2 * period_, longest_period);
    return Look::later;
  }
  is_looked_at_ = false;
  if (!is_read) go_full(has_unsent);
  return is_pinned_ ? Look::stuck : Look::done;
}

}  // namespace rr::channel
