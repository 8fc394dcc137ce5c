// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/channel.hpp"
#include "runtime/cpp/src/channel/connected.hpp"
#include "runtime/cpp/src/channel/stream_connection.hpp"
#include "runtime/cpp/src/channel/tcp_connect.hpp"
#include "runtime/cpp/src/channel/tcp_listener.hpp"
#include "runtime/cpp/src/channel/tls.hpp"

namespace rr::channel {
namespace {

bool is_encrypted(std::string_view scheme) {
  return scheme.starts_with("rrs+") || scheme.ends_with("+wss");
}

/// Plain, and with web sockets and TLS around it, as the scheme says.
class TcpChannel final : public Channel {
 public:
  explicit TcpChannel(ChannelContext context) : context_(std::move(context)) {}

  [[nodiscard]] ChannelTraits traits(std::string_view scheme) const override {
    return {.message_limit = context_.options->limits.message_size,
            .is_encrypted = is_encrypted(scheme)};
  }

  std::shared_ptr<Connection> connect(const Url& url, Time deadline,
                                      const AcceptHandler& make_receiver) override {
    Agreed agreed = connect_stream(resolve(url.host, url.port), url, context_, deadline);
    LinkTerms terms = tcp_terms(*context_.options, url.scheme == "tcp" ? "rr+tcp" : url.scheme);
    terms.traits.is_encrypted = is_encrypted(url.scheme);
    return connected(context_, std::move(agreed), std::move(terms), make_receiver);
  }

  std::unique_ptr<Listener> listen(const Url& url, AcceptHandler accept) override {
    return std::make_unique<TcpListener>(context_, url, std::move(accept));
  }

 private:
  const ChannelContext context_;
};

}  // namespace

std::shared_ptr<Channel> make_tcp_channel(ChannelContext context) {
  return std::make_shared<TcpChannel>(std::move(context));
}

std::shared_ptr<Connection> connected(const ChannelContext& context, Agreed agreed, LinkTerms terms,
                                      const AcceptHandler& make_receiver) {
  auto connection = std::make_shared<StreamConnection>(
      StreamConnection::Role::client, std::move(agreed.socket), context.reactor, context.options,
      std::move(terms), std::move(agreed.carrier));
  connection->set_certified_node(agreed.certified_node);
  connection->tell_handshake(agreed.request, agreed.answer);
  connection->set_agreement(agreed.remote_node, std::move(agreed.remote_name), agreed.agreement);
  connection->start(make_receiver(connection));
  if (agreed.proof) context.tls->watch(connection, std::move(agreed.proof));
  return connection;
}

}  // namespace rr::channel
