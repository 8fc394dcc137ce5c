// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "runtime/cpp/src/platform/ready.hpp"

namespace rr::platform {

/// Waits for many sockets. All functions may be called on any thread, also while one waits.
///
/// Edge-triggered: what is found at a socket is reported once, and again when more has come, when
/// a call that found no room has room, or after change(). The bits of ready::end are always
/// reported.
class Poller {
 public:
  /// Something at a socket, or, with no key, a wake-up.
  struct Event {
    void* key;
    std::uint32_t events;  ///< bits of `ready`
  };
  static constexpr std::size_t most_events = 64;

  /// Throws std::system_error.
  Poller();
  ~Poller();
  Poller(const Poller&) = delete;
  Poller& operator=(const Poller&) = delete;

  /// Watches a socket for bits of `ready`. Throws std::system_error, as change().
  void add(int socket, std::uint32_t events, void* key);
  /// Watches it for something else. What is there already is reported anew.
  void change(int socket, std::uint32_t events, void* key);
  /// An event of it that was not reported before is not reported any more.
  void remove(int socket);

  /// Reports what there is, most_events at once, and how many. Waits until there is something when
  /// it may; a signal ends that, too.
  std::size_t wait(std::span<Event> events, bool may_wait);
  /// A thread that waits returns, or the next one that would.
  void wake();

 private:
  struct System;
  const std::unique_ptr<System> system_;
};

}  // namespace rr::platform
