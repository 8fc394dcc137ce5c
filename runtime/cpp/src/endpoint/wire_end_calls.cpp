// SPDX-License-Identifier: Apache-2.0
// How a wire's end calls functions of the program, and how it ends.
#include <algorithm>
#include <utility>

#include "runtime/cpp/src/endpoint/newest_steps.hpp"
#include "runtime/cpp/src/endpoint/user_code.hpp"
#include "runtime/cpp/src/endpoint/wire_end.hpp"

namespace rr {

class WireEnd::State::Listener final : public Subscription::Handler {
 public:
  Listener(Function<void(const void*, const TimeSpec&)> function, std::uint64_t last)
      : seen(last), function_(std::move(function)) {}

  void call(const void* value, const TimeSpec& time) {
    run([&] { function_(value, time); });
  }

  std::uint64_t seen;  // the value it was called with last; guarded by the end

 private:
  void drop() override { function_ = nullptr; }

  Function<void(const void*, const TimeSpec&)> function_;
};

// Calls what is the program's.
template <class Call>
void WireEnd::State::guard(const Call& call) const {
  endpoint::call_user_code(*core_, "a function for the wire", member_.name, call);
}

Subscription WireEnd::State::on_received(Function<void(const void*, const TimeSpec&)> function) {
  look();
  channel::DeferredCallbacks deferred;
  std::shared_ptr<Listener> listener;
  bool must_start = false;
  {
    const MutexLock lock(mutex_);
    // One that has come already is the first.
    listener = std::make_shared<Listener>(std::move(function), in_.is_fresh() ? 0 : sequence_);
    if (is_ending()) return Subscription(std::move(listener));
    listeners_.push_back(listener);
    must_start = must_start_telling();
  }
  connection().expect();
  on_awaited();
  if (must_start) start_telling();
  for (const std::function<void()>& later : deferred) later();
  return Subscription(std::move(listener));
}

bool WireEnd::State::is_awaited() const {
  const MutexLock lock(mutex_);
  if (is_ending()) return false;
  return waiting_ != 0 || std::any_of(listeners_.begin(), listeners_.end(),
                                      [](const auto& one) { return one->is_connected(); });
}

void WireEnd::State::on_closed(Function<void()> function) {
  {
    const MutexLock lock(mutex_);
    if (!is_over_) {
      on_closed_.push_back(std::move(function));
      return;
    }
  }
  core_->reactor().post(
      [self = shared_from_this(), function = std::move(function)] { self->guard(function); });
}

bool WireEnd::State::begin_close() {
  const MutexLock lock(mutex_);
  if (is_ending()) return false;
  phase_ = Phase::closing;
  arrived_.notify_all();
  // Who closes it wants no more values.
  told_side_ = sequence_;
  for (const auto& listener : listeners_) listener->seen = sequence_;
  return true;
}

void WireEnd::State::finish(channel::DeferredCallbacks& /*deferred*/) {
  bool must_start = false;
  if (!Steps::finish(*this, must_start)) return;
  leave();
  if (must_start) start_telling();
}

void WireEnd::State::finish_now() {
  channel::DeferredCallbacks deferred;
  finish(deferred);
  for (const std::function<void()>& later : deferred) later();
}

bool WireEnd::State::has_to_tell() const {
  return (told_side_ != sequence_ && has_listener()) ||
         std::any_of(listeners_.begin(), listeners_.end(),
                     [&](const auto& listener)
                         RR_REQUIRES(mutex_) { return listener->seen != sequence_; });
}

bool WireEnd::State::must_start_telling() { return !is_telling_ && (is_telling_ = has_to_tell()); }

void WireEnd::State::start_telling() {
  core_->reactor().post([self = shared_from_this()] { self->tell_all(); }, connection().threads());
}

void WireEnd::State::tell_all() {
  std::shared_ptr<const void> value;
  TimeSpec time;
  bool tells_side = false;
  std::vector<Function<void()>> closed;
  std::vector<std::shared_ptr<Listener>> gone;
  while (next_turn(value, time, tells_side, closed, gone)) {
    gone.clear();
    for (const auto& listener : turn_) {
      guard([&] { listener->call(value.get(), time); });
    }
    turn_.clear();
    if (tells_side) guard([&] { tell(value.get(), time); });
    for (const Function<void()>& function : closed) guard(function);
    closed.clear();
  }
}

bool WireEnd::State::next_turn(std::shared_ptr<const void>& value, TimeSpec& time, bool& tells_side,
                               std::vector<Function<void()>>& closed,
                               std::vector<std::shared_ptr<Listener>>& gone) {
  return Steps::next_turn(*this, value, time, tells_side, closed, gone);
}

}  // namespace rr
