// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "rr/options.hpp"
#include "rr/url.hpp"
#include "runtime/cpp/src/channel/connection.hpp"
#include "runtime/cpp/src/channel/reactor.hpp"

namespace rr::channel {

/// What channels work with.
struct Ground {
  std::shared_ptr<Reactor> reactor;
  std::shared_ptr<const NodeOptions> options;  ///< with the id filled in
};

/// Somebody who listens; ends with the object.
class Listener {
 public:
  virtual ~Listener() = default;
  /// Where: `rr+tcp://0.0.0.0:6257`, the actual port filled in; several for several families.
  [[nodiscard]] virtual std::vector<std::string> urls() const = 0;
};

/// Gives each new incoming connection its receiver. Called on a thread of the node.
using AcceptHandler = std::function<std::shared_ptr<Receiver>(std::shared_ptr<Connection>)>;

/// A way to reach other nodes, named by the scheme of their URLs. It carries messages; how these
/// look on the way is its own affair.
class Channel {
 public:
  virtual ~Channel() = default;
  /// Connects, and agrees with the other side on how to talk. Blocks until the deadline. Messages
  /// go to what `make_receiver` returns for the connection. Throws rr::Error.
  virtual std::shared_ptr<Connection> connect(const Url& url, Time deadline,
                                              const AcceptHandler& make_receiver) = 0;
  /// Throws rr::Error.
  virtual std::unique_ptr<Listener> listen(const Url& url, AcceptHandler accept) = 0;
};

std::unique_ptr<Channel> make_tcp_channel(Ground ground);

/// A connection over one end of a connected stream socket, as a server: for tests, fuzzing, and
/// sockets that come from elsewhere. Takes over the descriptor.
std::shared_ptr<Connection> adopt_socket(const Ground& ground, int descriptor,
                                         const AcceptHandler& accept);

}  // namespace rr::channel
