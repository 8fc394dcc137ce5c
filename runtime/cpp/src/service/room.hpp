// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <thread>

#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/service/server_endpoint.hpp"

namespace rr::service {

/// Waits until `take()` has drawn what it wants from the account of a connection, which others
/// fill: what they have made is sent within milliseconds. Another thread polls meanwhile. False
/// when there was no room for so long, or the connection is closed.
template <class Take>
bool wait_for_room(ServerEndpoint& endpoint, channel::Milliseconds patience, Take&& take) {
  constexpr channel::Milliseconds period{2};
  channel::Reactor::about_to_wait();
  const channel::Time until = channel::after(channel::Clock::now(), patience);
  while (!take()) {
    if (channel::Clock::now() >= until || endpoint.connection().is_closed()) return false;
    std::this_thread::sleep_for(period);
  }
  return true;
}

}  // namespace rr::service
