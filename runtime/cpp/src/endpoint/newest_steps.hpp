// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "rr/mutex.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/endpoint/newest_value.hpp"

namespace rr::endpoint {

/// How the newest value of a wire's end gets to the program: to threads that wait for one, and to
/// functions that one thread calls, one value after the other. These are functions of the end,
/// which has the lock, the value and its number. See WireEnd::State.
template <class End>
struct NewestSteps {
  using Sync = typename End::Sync;
  using Lock = typename Sync::Lock;

  /// A value has come. One that is older than the newest is dropped. Swaps `charge` with that of
  /// the value before, which is left in `before`, as it may be large to free. True when telling has
  /// to be started.
  template <class Value, class Time, class Charge>
  static bool take(End& end, const Value& value, const Time& time, Charge& charge, Value& before);
  /// Whether there is a value now, or comes before the deadline.
  static bool wait(End& end, channel::Time deadline);
  /// What is to be told next, by the thread that tells. False when there is nothing: then this
  /// thread is done.
  template <class Value, class Time, class Functions, class Listeners>
  static bool next_turn(End& end, Value& value, Time& time, bool& tells_side, Functions& closed,
                        Listeners& gone);
  /// The end is closed. True when that is new; then `must_start` says whether telling has to be
  /// started.
  static bool finish(End& end, bool& must_start);
};

template <class End>
template <class Value, class Time, class Charge>
bool NewestSteps<End>::take(End& end, const Value& value, const Time& time, Charge& charge,
                            Value& before) {
  const Lock lock(end.mutex_);
  if (end.is_ending()) return false;
  if (end.sequence_ != 0 && !is_later(time, end.in_.time())) return false;
  before = end.in_.put(value, time);
  std::swap(end.charge_, charge);
  ++end.sequence_;
  end.on_taken(value, time);  // before anybody knows of it
  const bool must_start = end.must_start_telling();
  if (end.waiting_ != 0) end.arrived_.notify_all();
  return must_start;
}

template <class End>
bool NewestSteps<End>::wait(End& end, channel::Time deadline) {
  const Lock lock(end.mutex_);
  ++end.waiting_;
  while (!end.in_.is_fresh() && !end.is_ending() && Sync::now() < deadline) {
    Sync::wait_until(end.arrived_, end.mutex_, deadline);
  }
  --end.waiting_;
  return end.in_.is_fresh();
}

template <class End>
template <class Value, class Time, class Functions, class Listeners>
bool NewestSteps<End>::next_turn(End& end, Value& value, Time& time, bool& tells_side,
                                 Functions& closed, Listeners& gone) {
  Value before;
  {
    const Lock lock(end.mutex_);
    std::erase_if(end.listeners_, [&](const auto& listener) {
      if (!listener->is_connected()) gone.push_back(listener);
      return !listener->is_connected();
    });
    for (const auto& listener : end.listeners_) {
      if (std::exchange(listener->seen, end.sequence_) != end.sequence_) {
        end.turn_.push_back(listener);
      }
    }
    tells_side =
        std::exchange(end.told_side_, end.sequence_) != end.sequence_ && end.has_listener();
    before = std::exchange(value, end.in_.value());
    time = end.in_.time();
    if (!end.turn_.empty() || tells_side) return true;
    if (end.phase_ != End::Phase::closed) {
      end.is_telling_ = false;
      return false;
    }
    closed.swap(end.on_closed_);
    if (!closed.empty()) return true;
    gone.insert(gone.end(), end.listeners_.begin(), end.listeners_.end());
    end.listeners_.clear();
    end.is_over_ = true;
  }
  for (const auto& listener : gone) listener->disconnect();
  end.release();
  return false;
}

template <class End>
bool NewestSteps<End>::finish(End& end, bool& must_start) {
  const Lock lock(end.mutex_);
  if (end.phase_ == End::Phase::closed) return false;
  end.phase_ = End::Phase::closed;
  must_start = !std::exchange(end.is_telling_, true);
  end.arrived_.notify_all();
  return true;
}

}  // namespace rr::endpoint
