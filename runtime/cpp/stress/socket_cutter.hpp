// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <set>
#include <shared_mutex>
#include <string>

namespace rr::stress {

/// Cuts connections of this process behind the runtime's back, as a cable would.
class SocketCutter {
 public:
  /// Names a socket while it exists: the kernel's number.
  using Socket = std::string;

  /// Runs what makes a connection.
  void connect(const std::function<void()>& connecting);
  /// The same; returns the socket that was made. Empty when there is none.
  Socket connect_and_find(const std::function<void()>& connecting);
  /// Ends the connection in both directions. `resets`: what the other side sees is a reset.
  void cut(const Socket& socket, bool resets);

 private:
  static std::set<Socket> sockets();

  std::shared_mutex mutex_;  // while held alone no socket is made
};

}  // namespace rr::stress
