// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "runtime/cpp/src/channel/reactor.hpp"

namespace rr::channel {

/// The threads of a reactor that poll and watch.
constexpr unsigned duties = 2;

struct Reactor::Polling {
  Reactor* reactor;
  std::uint64_t turn;                         // what turn_ is while the thread has it
  std::shared_ptr<ThreadShare> posted_for{};  // of the posted work that it runs
  Time yield_at = Time::min();                // of the handler; min() until that asks
  // Written by who takes the turn away, under the lock:
  std::shared_ptr<ThreadShare> held_by{};
  bool is_held = false;
  const Pollable* inside = nullptr;  // whose handler the thread is in, or is about to enter
};

}  // namespace rr::channel
