// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/channel.hpp"
#include "runtime/cpp/src/channel/stream_connection.hpp"
#include "runtime/cpp/src/channel/tcp_connect.hpp"
#include "runtime/cpp/src/channel/tcp_listener.hpp"

namespace rr::channel {
namespace {

class TcpChannel final : public Channel {
 public:
  explicit TcpChannel(Ground ground) : ground_(std::move(ground)) {}

  std::shared_ptr<Connection> connect(const Url& url, Time deadline,
                                      const AcceptHandler& make_receiver) override {
    Agreed agreed = connect_stream(url, *ground_.options, deadline);
    auto connection = std::make_shared<StreamConnection>(
        StreamConnection::Role::client, std::move(agreed.socket), ground_.reactor, ground_.options);
    connection->tell_handshake(agreed.request, agreed.answer);
    connection->set_agreement(agreed.remote_node, std::move(agreed.remote_name), agreed.agreement);
    connection->start(make_receiver(connection));
    return connection;
  }

  std::unique_ptr<Listener> listen(const Url& url, AcceptHandler accept) override {
    return std::make_unique<TcpListener>(ground_, url, std::move(accept));
  }

 private:
  const Ground ground_;
};

}  // namespace

std::unique_ptr<Channel> make_tcp_channel(Ground ground) {
  return std::make_unique<TcpChannel>(std::move(ground));
}

std::shared_ptr<Connection> adopt_socket(const Ground& ground, int descriptor,
                                         const AcceptHandler& accept) {
  Descriptor socket(descriptor);
  if (!ground.accepted->add()) {
    throw Error(ErrorCode::connection_error, "the node has as many connections as it may");
  }
  auto connection = std::make_shared<StreamConnection>(
      StreamConnection::Role::server, std::move(socket), ground.reactor, ground.options);
  connection->set_on_gone([count = ground.accepted](StreamConnection&) { count->remove(); });
  try {
    connection->start(accept(connection));
  } catch (const std::exception& error) {
    connection->close(Error(ErrorCode::connection_error, error.what()));
    throw;
  }
  return connection;
}

}  // namespace rr::channel
