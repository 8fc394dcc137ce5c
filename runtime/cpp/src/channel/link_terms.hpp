// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "rr/channel.hpp"
#include "rr/options.hpp"
#include "runtime/cpp/src/platform/users.hpp"

namespace rr::channel {

class Tls;
class WebSockets;

/// What holds for the connections of one channel.
struct LinkTerms {
  ChannelTraits traits{};
  std::string scheme = "rr+tcp";  ///< of URLs made from the socket's address
  std::string local_url{};        ///< instead of one made from the address
  std::chrono::milliseconds heartbeat_period{};
  std::chrono::milliseconds receive_timeout{};
  std::uint32_t size_before_connect = 0;
  // What the first bytes of a client may ask for; null: nothing of that.
  std::shared_ptr<WebSockets> web_sockets{};
  std::shared_ptr<const Tls> tls{};
  /// Of local sockets: this user and root may connect, nobody else; nothing: all who can.
  std::optional<platform::UserId> only_user{};
  /// Nothing but TLS is served.
  bool is_tls_required = false;
  /// Clients may ask for shared memory.
  bool shares_memory = false;
};

/// Those of TCP.
inline LinkTerms tcp_terms(const NodeOptions& options, std::string scheme = "rr+tcp") {
  LinkTerms terms;
  terms.scheme = std::move(scheme);
  terms.heartbeat_period = options.heartbeat_period;
  terms.receive_timeout = options.receive_timeout;
  terms.size_before_connect = options.size_before_connect;
  return terms;
}

}  // namespace rr::channel
