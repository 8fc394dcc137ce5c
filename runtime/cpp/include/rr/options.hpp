// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rr/audit.hpp"
#include "rr/definition_check.hpp"
#include "rr/log.hpp"
#include "rr/node_id.hpp"
#include "rr/visibility.hpp"
#include "rr/wire.hpp"

namespace RR_VISIBLE rr {

class IntraSpace;
class MessageChannel;
class Tap;

/// What one side of a new connection offers the other (04, section 4.4). Both must want a thing.
struct Offer {
  bool message_v4 = true;        ///< the compact message format
  bool string_table = true;      ///< codes for frequent strings; needs message_v4
  bool combined_connect = true;  ///< connecting to a service in one step instead of four
};

/// TLS of a node (04, section 6; docs/explanation/security.md). Files are read when the node is
/// made, and again when they have changed; one that cannot be used then leaves in use what was read
/// before.
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
  /// a node is refused with any other, be its authority trusted or not. With `rr+wss` it may be a
  /// host's certificate, which then proves the node too.
  std::map<NodeId, std::string> pins{};
  /// Nothing but TLS, in both directions: clients that do not use it are refused, and this node
  /// connects to no peer without it. Local and in-process channels are excepted.
  bool is_required = false;
  /// Clients have to prove which node they are, when they use TLS.
  bool must_certify_clients = false;
  /// Whether the authorities of the system prove hosts of `rr+wss`, as in a browser. Unset: only
  /// where no authority file is given, in the options or by the environment.
  std::optional<bool> trust_system_authorities{};
  /// Lists of revoked certificates that have run out are used all the same; otherwise certificates
  /// of their authorities are refused then. Connections that are open stay.
  bool accepts_outdated_lists = false;
  /// How often the files are looked at besides at each new connection, and open connections closed
  /// whose other side would be refused by them. Zero: never.
  std::chrono::milliseconds look_again_period{5'000};
};

/// Web sockets of a node, on the ports of TCP (04, section 2.2).
struct WebSocketOptions {
  /// Whether the node takes web sockets at the ports at which it listens, and connects by them.
  bool is_enabled = true;
  /// Origins of pages that may connect: `scheme://host[:port]`, `*.` before a host for those below
  /// it, `scheme://` for all of that scheme. Empty: no page may connect. Programs that are no
  /// browsers send no origin, and are not asked for one.
  std::vector<std::string> origins{"https://robotraconteur.com", "https://*.robotraconteur.com"};
  /// Pages without an origin may connect too (`null`, `file://`): files that the user opens, but
  /// also any page of the web, which needs only a sandboxed frame for it
  /// (docs/explanation/security.md).
  bool allow_local_pages = false;
  /// A file with the page of the inspector, which is served at `http://host:port/` and may then
  /// connect: that page of this node, and no other of this machine. Every host that reaches the
  /// port gets it. Empty: nothing is served. Compressed by gzip it may have up to 1 MB.
  std::string inspector_page{};
};

/// The state of a node, shown at its TCP ports: `GET /metrics` and `GET /health`
/// (docs/howto/monitoring.md). Needs web sockets (WebSocketOptions::is_enabled), and robdef::web.
struct MetricsOptions {
  /// Whether the node counts, and answers these requests.
  bool is_enabled = false;
  /// From where they are answered, besides this machine: addresses and networks (`10.0.0.5`,
  /// `192.168.10.0/24`, `fd00::/8`), or `*` for everywhere. Another text makes the node throw
  /// rr::Error (invalid_argument).
  std::vector<std::string> from{};
  /// Names of this machine by which it may be asked, besides its addresses, `localhost` and its
  /// host name. Any other name is refused: a page of the web can have its own name point here.
  std::vector<std::string> hosts{};
};

/// Local sockets of a node (04, section 7).
struct LocalOptions {
  /// Instead of the user's and the system's run directories, and those that the environment names.
  std::string user_run_dir{};
  /// The system's run directory; empty as above.
  std::string system_run_dir{};
  /// As NodeOptions::heartbeat_period, of local sockets.
  std::chrono::milliseconds heartbeat_period{30'000};
  /// As NodeOptions::receive_timeout, of local sockets.
  std::chrono::milliseconds receive_timeout{600'000};
  /// Whether messages go through memory that both nodes map, where both have this, instead of the
  /// socket (docs/reference/shared_memory.md). No effect where the system has none.
  bool shared_memory = false;
};

/// How many bytes the peers of a node may make it hold, all connections together
/// (docs/reference/limits.md). One connection gets at most two thirds of a pool, and many get equal
/// shares.
struct Budget {
  /// Before a client has connected to a service and, where users are needed, logged in.
  std::size_t before_session = 8 * 1024 * 1024;
  /// In sessions with services of this node. 0: 39 MiB, or 3.25 of the largest messages if that is
  /// more.
  std::size_t sessions = 0;
  /// Each connection may hold so much in a pool that is full.
  std::size_t reserve = 64 * 1024;
  /// What the service of one session makes a client of this node hold: packets of all its pipes and
  /// what waits to be handled. Never less than 3.5 of the largest messages.
  std::size_t client_session = 64 * 1024 * 1024;
  /// Memory of the lists, maps and structs of one request. 0: three of the largest messages.
  std::size_t containers = 0;
  /// The same before the client has logged in where it has to.
  std::size_t containers_before_login = 1024 * 1024;
  /// A connection whose message does not fit into its pool is not read meanwhile; closed after this
  /// time.
  std::chrono::milliseconds patience{2'000};
  /// Whether the first connection that is accepted fixes two thresholds of glibc's malloc for the
  /// process (docs/reference/limits.md), so that memory that peers have used returns to the system.
  bool fixes_heap_thresholds = true;
};

/// Logging in to the services of a node (docs/howto/access.md). Passwords are checked on threads
/// that do nothing else.
struct LoginOptions {
  /// So many at a time; 0: one, or two on a machine with more than two processors.
  unsigned threads = 0;
  /// Attempts that wait for a thread or for their delay. One more is refused with
  /// AuthenticationError, which says that the service is busy.
  std::size_t queue_limit = 32;
  /// After a failure the next attempt of the connection, and after some of its remote address,
  /// waits for so long; after each further one twice as long.
  std::chrono::milliseconds first_delay{250};
  /// The longest of these times.
  std::chrono::milliseconds max_delay{8'000};
  /// Failures of an address are forgotten when so long nothing has failed.
  std::chrono::milliseconds memory{300'000};
  /// A connection is closed after so many failures; 0: never.
  unsigned max_failures = 5;
};

/// How a node behaves, by default as the existing implementations. Large because each field is one
/// choice of a program. Times over a hundred years, as milliseconds::max(), never come.
struct NodeOptions {
  /// Name of the node: letters, digits, underscores, points and hyphens, a letter first, 1024 at
  /// most. Empty for none. Another one makes the node throw rr::Error (invalid_argument).
  std::string name{};
  /// Zero: a random one.
  NodeId id{};

  /// Threads that the node may have. Two are enough until handlers block; see rr/node.hpp. They are
  /// made when they are needed, and end when they have had nothing to do for 10 s.
  unsigned max_threads = 128;
  /// Threads that the handlers of one session may hold, those that wait for callbacks included.
  /// Further requests wait in the queue of the session.
  unsigned session_threads = 16;
  /// Where reports go; nothing is printed. Called on any thread, under no lock.
  std::function<void(LogLevel, std::string_view)> log{};
  /// The same with its parts: time, node, peer, session (rr/log.hpp). Both are called where both
  /// are given. What it throws is dropped.
  std::function<void(const LogRecord&)> log_record{};

  /// What this node offers where it connects.
  Offer client_offer{};
  /// What it offers to those that connect to it.
  Offer server_offer{.string_table = false};

  /// How long a call waits for its answer, unless the call says otherwise.
  std::chrono::milliseconds request_timeout{15'000};
  /// From looking up the host's name to the first message both understand. The look-up itself is
  /// not interrupted: a name server that does not answer can take longer.
  std::chrono::milliseconds connect_timeout{5'000};
  /// A server closes connections that have not brought a whole message after this time.
  std::chrono::milliseconds first_message_timeout{5'000};
  /// A server closes a connection on which a message of some size has begun and is not whole after
  /// this time and another second for each 64 KiB of it.
  std::chrono::milliseconds message_timeout{10'000};
  /// A side that has sent nothing for so long sends a connection test; a server waits a fifth
  /// longer.
  std::chrono::milliseconds heartbeat_period{10'000};
  /// A connection is given up when nothing came for so long after something was sent.
  std::chrono::milliseconds receive_timeout{15'000};
  /// A connected client that has sent nothing for so long tells its service that it is there.
  std::chrono::milliseconds keep_alive_period{60'000};
  /// A service drops clients that it has not heard for so long.
  std::chrono::milliseconds client_timeout{600'000};
  /// A service drops generators that were not used for so long, and those that their client has
  /// closed after this time or 30 s, whichever is less.
  std::chrono::milliseconds generator_timeout{600'000};

  /// The largest messages and how deep they may nest.
  Limits limits{};
  /// Bytes of a memory that travel in one request; the smaller one of both sides counts. Larger
  /// transfers are cut (07, section 13).
  std::uint32_t memory_transfer_limit = 102'400;
  /// Largest message, in bytes, before a client has connected to a service.
  std::uint32_t size_before_connect = 512 * 1024;
  /// Incoming connections at a time, those of adopt() included; 0: no limit. For one more the
  /// oldest without a session is closed; if there is none, the new one is.
  std::size_t max_connections = 0;
  /// Of these without a session: those that have not connected to a service or, where users are
  /// needed, not logged in; 0: no limit. For one more the oldest of them is closed.
  std::size_t max_connections_before_session = 256;
  /// Of these from one address: of IPv6 the first 64 bits, by local sockets a user; 0: no limit.
  /// For one more the oldest of them is closed.
  std::size_t max_connections_per_address = 128;
  /// Bytes that may wait to be sent on one connection before it is given up.
  std::size_t send_queue_limit = 64 * 1024 * 1024;
  /// Bytes of requests that wait for their handlers before a connection is read no further.
  std::size_t request_queue_limit = 1024 * 1024;
  /// Bytes of answers and the like that wait to be sent on one connection before no more of its
  /// requests are handled, nor is it read.
  std::size_t answer_queue_limit = 1024 * 1024;

  /// What all connections together may make the node hold.
  Budget budget{};
  /// What a client takes of the definitions that a service sends.
  DefinitionLimits definitions{};
  /// What a client does about members that the service declares otherwise than this program knows
  /// them, unless ConnectOptions says otherwise.
  DefinitionCheck definition_check = DefinitionCheck::report;

  /// How users log in.
  LoginOptions login{};

  /// Certificates, and whether they are asked for.
  TlsOptions tls{};
  /// Web sockets, and which pages may use them.
  WebSocketOptions web_socket{};
  /// Metrics and health at the TCP ports; off by default.
  MetricsOptions metrics{};
  /// Local sockets.
  LocalOptions local{};
  /// How long a thread that waits for a message keeps looking for it before it sleeps; with shared
  /// memory only, and only while the other side runs on another processor. Answers come sooner by
  /// the time that a wake-up takes, and the processor is busy meanwhile. 1 ms at most. 0: it sleeps
  /// at once.
  std::chrono::microseconds spin{0};
  /// Where nodes find each other by `rr+intra`; null: all of the process do.
  std::shared_ptr<IntraSpace> intra{};
  /// Channels of one's own by the schemes of their URLs, which must be other than ours.
  std::map<std::string, std::shared_ptr<MessageChannel>> channels{};

  /// Notified of clients that connect, disconnect, log in and are refused (rr/audit.hpp); none by
  /// default.
  AuditOptions audit{};

  /// Hears every message that the node sends and receives (rr/tap.hpp); none by default.
  std::shared_ptr<Tap> tap{};
};

}  // namespace rr
