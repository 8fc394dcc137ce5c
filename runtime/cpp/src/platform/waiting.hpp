// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <system_error>

#include "rr/visibility.hpp"
#include "runtime/cpp/src/platform/clock.hpp"
#include "runtime/cpp/src/platform/ready.hpp"
#include "runtime/cpp/src/platform/sockets.hpp"

/// Waiting for a few sockets, by the thread that wants them. For many: Poller.
namespace rr::platform {

/// Waits for bits of `ready` at a socket, or its end; false at the deadline. Time::max() is none.
RR_INSIDE bool wait_for(int socket, std::uint32_t events, Time deadline);

/// One of several sockets that are waited for.
struct Awaited {
  int socket = -1;           ///< less than 0: none
  std::uint32_t wanted = 0;  ///< bits of `ready`; its end is always told of
  std::uint32_t found = 0;   ///< what was there
};
/// The same for several at once: until something is found at one of them.
RR_INSIDE bool wait_for_any(std::span<Awaited> sockets, Time deadline);

/// Can be waited for as if it were a socket: has input from ring() on, for ever.
class Bell {
 public:
  /// `error` when the system has none left.
  explicit Bell(std::error_code& error);
  void ring() const;
  [[nodiscard]] int descriptor() const { return event_.get(); }

 private:
  Descriptor event_;
  Descriptor ringer_;  // the end that is written to, where that is another
};

}  // namespace rr::platform
