// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/accept.hpp"

#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/remote_address.hpp"
#include "runtime/cpp/src/channel/stream_connection.hpp"
#include "runtime/cpp/src/platform/memory.hpp"

namespace rr::channel {
namespace {

// What the connection makes this node hold counts as that of a session as long as it is in one, and
// its place is then its own.
void account_for(StreamConnection& connection, const ChannelContext& context,
                 const std::shared_ptr<Admission::Place>& place) {
  if (context.pools.before_session) {
    connection.set_account(std::make_shared<Account>(context.pools.before_session, no_limit));
  }
  connection.set_on_authorised(
      [place, pools = context.pools, account = connection.account()](bool is_authorised) {
        place->set_authorised(is_authorised);
        if (account) account->move_to(is_authorised ? pools.sessions : pools.before_session);
      });
  connection.set_on_gone([place, accepted = context.accepted](const StreamConnection& gone) {
    place->leave();
    const ErrorCode code = gone.why_closed().code();
    if (code != ErrorCode::out_of_system_resource && code != ErrorCode::operation_timeout) return;
    const std::string& from = place->address();
    accepted->warn("a connection" + (from.empty() ? std::string() : " of " + from) +
                   " is closed: " + gone.why_closed().message());
  });
}

}  // namespace

std::shared_ptr<Connection> accept_connection(const ChannelContext& context, Descriptor socket,
                                              LinkTerms terms, std::unique_ptr<Carrier> carrier,
                                              const AcceptHandler& accept) {
  if (context.options->budget.fixes_heap_thresholds) platform::fix_heap_thresholds();
  // The socket of a carrier that is not TCP or local tells nothing of the other side.
  std::string from =
      carrier == nullptr ? remote_key(remote_address_of(socket.get())) : std::string();
  const std::shared_ptr<Admission::Place> place = context.accepted->enter(std::move(from));
  if (!place) {
    throw Error(ErrorCode::connection_error, "the node has as many connections as it may");
  }
  auto connection = std::make_shared<StreamConnection>(
      StreamConnection::Role::server, std::move(socket), context.reactor, context.options,
      std::move(terms), std::move(carrier));
  account_for(*connection, context, place);
  try {
    if (!place->take(connection)) {
      throw Error(ErrorCode::connection_error, "the node has too many connections");
    }
    connection->start(accept(connection));
  } catch (const std::exception& error) {
    connection->close(Error(ErrorCode::connection_error, error.what()));
    throw;
  }
  return connection;
}

std::shared_ptr<Connection> adopt_socket(const ChannelContext& context, int descriptor,
                                         const AcceptHandler& accept) {
  LinkTerms terms = tcp_terms(*context.options);
  terms.tls = context.tls;
  terms.is_tls_required = context.options->tls.is_required;
  return accept_connection(context, Descriptor(descriptor), std::move(terms), nullptr, accept);
}

}  // namespace rr::channel
