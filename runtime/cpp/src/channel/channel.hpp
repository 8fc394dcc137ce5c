// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "rr/options.hpp"
#include "rr/url.hpp"
#include "runtime/cpp/src/channel/account.hpp"
#include "runtime/cpp/src/channel/admission.hpp"
#include "runtime/cpp/src/channel/connection.hpp"
#include "runtime/cpp/src/channel/reactor.hpp"

namespace rr::channel {

class Tls;
class WebSockets;

/// What the peers of a node may make it hold.
struct Pools {
  std::shared_ptr<Pool> before_session;
  std::shared_ptr<Pool> sessions;
};
/// Those that the options describe.
Pools make_pools(const NodeOptions& options);
/// Gives memory back to the system when much has been given back to the pools (memory_return.cpp).
void watch_pools(const Pools& pools, const std::shared_ptr<Reactor>& reactor);

/// What channels work with.
struct ChannelContext {
  std::shared_ptr<Reactor> reactor;
  std::shared_ptr<const NodeOptions> options;  ///< with the id filled in
  std::shared_ptr<Admission> accepted;
  Pools pools{};
  std::shared_ptr<const Tls> tls{};           ///< null where the program has no TLS
  std::shared_ptr<WebSockets> web_sockets{};  ///< likewise
};

/// Somebody who listens; ends with the object.
class Listener {
 public:
  virtual ~Listener() = default;
  /// Where: `rr+tcp://0.0.0.0:6257`, the actual port filled in; several for several families.
  [[nodiscard]] virtual std::vector<std::string> urls() const = 0;
  /// What the node offers has changed, which `nonce`, 16 letters and digits, tells those who watch.
  virtual void services_changed(const std::string& /*nonce*/) {}
};

/// Gives each new incoming connection its receiver. Called on a thread of the node.
using AcceptHandler = std::function<std::shared_ptr<Receiver>(std::shared_ptr<Connection>)>;

/// A way to reach other nodes, named by the scheme of their URLs. It carries messages; how these
/// look on the way is its own affair.
class Channel {
 public:
  virtual ~Channel() = default;
  [[nodiscard]] virtual ChannelTraits traits(std::string_view scheme) const = 0;
  /// Connects, and agrees with the other side on how to talk. Blocks until the deadline. Messages
  /// go to what `make_receiver` returns for the connection. Throws rr::Error.
  virtual std::shared_ptr<Connection> connect(const Url& url, Time deadline,
                                              const AcceptHandler& make_receiver) = 0;
  /// The service that a URL without one means, as MessageChannel::service_at().
  virtual std::string service_at(const Url& /*url*/, Time /*deadline*/) { return {}; }
  /// Throws rr::Error.
  virtual std::unique_ptr<Listener> listen(const Url& url, AcceptHandler accept) = 0;
};

/// What can be used with an `rr::Node`: scheme and channel, ours and those of the options. Throws
/// rr::Error (invalid_argument) when the options give one of our schemes to another channel.
std::map<std::string, std::shared_ptr<Channel>> all_channels(const ChannelContext& context);

std::shared_ptr<Channel> make_tcp_channel(ChannelContext context);
std::shared_ptr<Channel> make_local_channel(ChannelContext context);
/// A channel over one that carries whole messages.
std::shared_ptr<Channel> make_message_channel(ChannelContext context, std::string scheme,
                                              std::shared_ptr<MessageChannel> channel);

/// A connection over one end of a connected stream socket, as a server: for tests, fuzzing, and
/// sockets that come from elsewhere. Takes over the descriptor. Throws rr::Error (connection_error)
/// when the node has as many connections as it may, and what `accept` throws.
std::shared_ptr<Connection> adopt_socket(const ChannelContext& context, int descriptor,
                                         const AcceptHandler& accept);

}  // namespace rr::channel
