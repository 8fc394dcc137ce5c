// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "rr/node_id.hpp"
#include "rr/wire.hpp"

namespace rr {

class IntraSpace;
class MessageChannel;
class Tap;

enum class LogLevel : std::uint8_t { debug, info, warning, error };

/// What one side of a new connection offers the other (04, section 4.4). Both must want a thing.
struct Offer {
  bool message_v4 = true;        ///< the compact message format
  bool string_table = true;      ///< codes for frequent strings; needs message_v4
  bool combined_connect = true;  ///< connecting to a service in one step instead of four
};

/// TLS of a node (04, section 6; docs/security.md). Files are read when the node is made; lists of
/// revoked certificates again whenever they have changed.
struct TlsOptions {
  /// The node's certificate with those between it and its authority: PEM, or `.p12` without a
  /// password, which holds the key too. Empty for none; the node's id must be the certificate's.
  std::string certificate_file{};
  /// Its key, PEM without a password; empty when it is in the same file.
  std::string key_file{};
  /// Certificates, PEM, of the authorities that are trusted, besides those that the environment
  /// names: ROBOTRACONTEUR_SSL_CERT_FILE and, of a folder, ROBOTRACONTEUR_SSL_CERT_DIR.
  std::vector<std::string> authority_files{};
  /// Lists, PEM, of the certificates that authorities have revoked.
  std::vector<std::string> revocation_files{};
  /// Nodes that are trusted for their certificate alone: its SHA-256 as 64 hexadecimal digits. Such
  /// a node is refused with any other, be its authority trusted or not.
  std::map<NodeId, std::string> pins{};
  /// Clients that do not use TLS are refused, except by local and in-process channels.
  bool is_required = false;
  /// Clients have to prove which node they are, when they use TLS.
  bool must_certify_clients = false;
};

/// Web sockets of a node, on the ports of TCP (04, section 2.2).
struct WebSocketOptions {
  bool is_enabled = true;
  /// Origins of pages that may connect: `scheme://host[:port]`, `*.` before a host for those below
  /// it, `scheme://` for all of that scheme.
  std::vector<std::string> origins{"null",
                                   "file://",
                                   "chrome-extension://",
                                   "http://robotraconteur.com",
                                   "http://*.robotraconteur.com",
                                   "https://robotraconteur.com",
                                   "https://*.robotraconteur.com"};
};

/// Local sockets of a node (04, section 7).
struct LocalOptions {
  /// Instead of the user's and the system's run directories, and those that the environment names.
  std::string user_run_dir{};
  std::string system_run_dir{};
  std::chrono::milliseconds heartbeat_period{30'000};
  std::chrono::milliseconds receive_timeout{600'000};
};

/// How a node behaves. The defaults are those of the existing implementations. Times over a hundred
/// years, as milliseconds::max(), never come.
struct NodeOptions {
  /// Name of the node: letters, digits, `_`, `.`, `-`, a letter first, 1024 at most. Empty for
  /// none. Another one makes the node throw rr::Error (invalid_argument).
  std::string name{};
  /// Zero: a random one.
  NodeId id{};

  /// Threads that the node may have. Two are enough until handlers block; see rr/node.hpp.
  unsigned max_threads = 32;
  /// Where reports go; nothing is printed. Called on any thread, under no lock.
  std::function<void(LogLevel, std::string_view)> log{};

  Offer client_offer{};
  Offer server_offer{.string_table = false};

  /// How long a call waits for its answer, unless the call says otherwise.
  std::chrono::milliseconds request_timeout{15'000};
  /// From looking up the host's name to the first message both understand. The look-up itself is
  /// not interrupted: a name server that does not answer can take longer.
  std::chrono::milliseconds connect_timeout{5'000};
  /// A server closes connections that have not brought a whole message after this time.
  std::chrono::milliseconds first_message_timeout{5'000};
  /// A side that has sent nothing for so long sends a connection test; a server waits a fifth
  /// longer.
  std::chrono::milliseconds heartbeat_period{10'000};
  /// A connection is given up when nothing came for so long after something was sent.
  std::chrono::milliseconds receive_timeout{15'000};
  /// A connected client that has sent nothing for so long tells its service that it is there.
  std::chrono::milliseconds keep_alive_period{60'000};
  /// A service drops clients that it has not heard for so long.
  std::chrono::milliseconds client_timeout{600'000};
  /// A service drops generators that nobody has used for so long, and those that their client has
  /// closed after this time or 30 s, whichever is less.
  std::chrono::milliseconds generator_timeout{600'000};

  Limits limits{};
  /// Bytes of a memory that travel in one request; the smaller one of both sides counts. Larger
  /// transfers are cut (07, section 13).
  std::uint32_t memory_transfer_limit = 102'400;
  /// Largest message, in bytes, before a client has connected to a service.
  std::uint32_t size_before_connect = 512 * 1024;
  /// Incoming connections at a time, those of adopt() included; 0: no limit. One more is closed at
  /// once.
  std::size_t max_connections = 0;
  /// Bytes that may wait to be sent on one connection before it is given up.
  std::size_t send_queue_limit = 64 * 1024 * 1024;
  /// Bytes of requests that wait for their handlers before a connection is read no further.
  std::size_t request_queue_limit = 1024 * 1024;

  TlsOptions tls{};
  WebSocketOptions web_socket{};
  LocalOptions local{};
  /// Where nodes find each other by `rr+intra`; null: all of the process do.
  std::shared_ptr<IntraSpace> intra{};
  /// Channels of one's own by the schemes of their URLs, which must be other than ours.
  std::map<std::string, std::shared_ptr<MessageChannel>> channels{};

  /// Hears every message that the node sends and receives (rr/tap.hpp); none by default.
  std::shared_ptr<Tap> tap{};
};

}  // namespace rr
