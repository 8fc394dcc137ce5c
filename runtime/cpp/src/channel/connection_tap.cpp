// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/connection_tap.hpp"

#include "runtime/cpp/src/channel/capabilities.hpp"
#include "runtime/cpp/src/channel/socket.hpp"

namespace rr::channel {

void ConnectionTap::open(int socket) {
  if (tap_ == nullptr) return;
  const std::string own = url_of(platform::local_address(socket));
  const std::string remote = url_of(platform::remote_address(socket));
  number_ = tap_->opened({.side = is_client_ ? TapSide::client : TapSide::service,
                          .client_url = is_client_ ? own : remote,
                          .service_url = is_client_ ? remote : own});
}

void ConnectionTap::agreed(const NodeOptions& own, const NodeId& remote_node,
                           const std::string& remote_name, const Agreement& agreement) const {
  if (tap_ == nullptr) return;
  tap_->agreed(number_, {.client_node = is_client_ ? own.id : remote_node,
                         .service_node = is_client_ ? remote_node : own.id,
                         .client_name = is_client_ ? own.name : remote_name,
                         .service_name = is_client_ ? remote_name : own.name,
                         .version = agreement.version,
                         .combined_connect = agreement.combined_connect,
                         .local_strings = agreement.local_strings,
                         .standard_strings = agreement.standard_strings});
}

std::uint64_t ConnectionTap::tell(bool is_own, std::span<const Piece> message) const {
  const bool is_request = is_own == is_client_;
  return tap_->message(number_, is_request ? Direction::to_service : Direction::to_client, message);
}

}  // namespace rr::channel
