// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "runtime/cpp/src/platform/ready.hpp"

namespace rr::channel {

class Pollable;

namespace ready = platform::ready;

/// Watches sockets: the reactor.
class Watcher {
 public:
  // `events` are bits of rr::channel::ready. Edge-triggered: each is reported once, until it is
  // requested again. Throw std::system_error.
  virtual void add(int socket, std::uint32_t events, Pollable& pollable) = 0;
  virtual void change(int socket, std::uint32_t events, Pollable& pollable) = 0;
  virtual void remove(int socket) = 0;

 protected:
  ~Watcher() = default;
};

}  // namespace rr::channel
