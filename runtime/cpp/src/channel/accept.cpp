// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/accept.hpp"

#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/stream_connection.hpp"

namespace rr::channel {

std::shared_ptr<Connection> accept_connection(const Ground& ground, Descriptor socket,
                                              LinkTerms terms, std::unique_ptr<Carrier> carrier,
                                              const AcceptHandler& accept) {
  if (!ground.accepted->add()) {
    throw Error(ErrorCode::connection_error, "the node has as many connections as it may");
  }
  auto connection = std::make_shared<StreamConnection>(
      StreamConnection::Role::server, std::move(socket), ground.reactor, ground.options,
      std::move(terms), std::move(carrier));
  connection->set_on_gone([count = ground.accepted](StreamConnection&) { count->remove(); });
  try {
    connection->start(accept(connection));
  } catch (const std::exception& error) {
    connection->close(Error(ErrorCode::connection_error, error.what()));
    throw;
  }
  return connection;
}

std::shared_ptr<Connection> adopt_socket(const Ground& ground, int descriptor,
                                         const AcceptHandler& accept) {
  return accept_connection(ground, Descriptor(descriptor), tcp_terms(*ground.options), nullptr,
                           accept);
}

}  // namespace rr::channel
