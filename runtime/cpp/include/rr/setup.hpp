// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <iosfwd>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "rr/discovery.hpp"
#include "rr/node.hpp"
#include "rr/options.hpp"
#include "rr/visibility.hpp"

/// A node that is set up by its command line and environment, as users know it.
namespace RR_VISIBLE rr {

/// What a set-up starts. Large because each has a flag `--robotraconteur-...` named as itself, with
/// `-` for `_`, and a variable `ROBOTRACONTEUR_...`, in capitals; flags win over variables, these
/// over the file that the flag or variable `config` names, and that over what the program says.
struct SetupOptions {
  /// All that no flag says. Its name and id are those of the node.
  NodeOptions node{};

  std::uint16_t tcp_port = 0;  ///< 0: any
  /// Finds others: Discovery::listen().
  bool discovery_listening_enable = true;
  /// Is found by others: Discovery::announce(). Only with a TCP server.
  bool discovery_announce_enable = false;
  /// Announcements and requests are also sent to the IPv4 broadcast address.
  bool tcp_ipv4_discovery = false;
  /// Announcements and requests are sent to the link-local IPv6 group.
  bool tcp_ipv6_discovery = true;
  /// Allows TCP, web sockets included.
  bool tcp_enable = true;
  /// Accepts connections by TCP, at `tcp_port`.
  bool tcp_start_server = false;
  /// Accepts connections of this machine only. False: of every machine that reaches this one.
  bool tcp_listen_localhost = true;
  /// Accepted, without effect.
  bool tcp_start_server_sharer = false;
  /// Allows local sockets.
  bool local_enable = true;
  /// Accepts connections by local sockets; the node's id is kept by its name.
  bool local_start_server = false;
  bool local_start_client = false;  ///< a client whose id is kept by its name, too
  /// Other users of this machine may connect by local sockets, too.
  bool local_server_public = false;
  /// Allows connections between nodes of this process.
  bool intra_enable = true;
  /// Accepts connections from nodes of this process.
  bool intra_start_server = false;
  /// Accepted, without effect.
  bool hardware_enable = false;
  /// The node has a certificate: `tls_certificate`, that of `node.tls` or, without either, the file
  /// `certificates/<node id>.p12` in the user's configuration folder. Without one it is not made.
  bool load_tls = false;
  bool require_tls = false;  ///< TlsOptions::is_required
  /// In place of TlsOptions::certificate_file and key_file; the node's id is the certificate's.
  std::string tls_certificate{};
  /// TlsOptions::key_file.
  std::string tls_key{};
  std::vector<std::string> tls_authority{};   ///< besides TlsOptions::authority_files
  std::vector<std::string> tls_revocation{};  ///< besides TlsOptions::revocation_files
  bool disable_timeouts = false;              ///< for who stops programs to look into them
  /// Does not offer message format 4.
  bool disable_message4 = false;
  /// Does not offer string tables.
  bool disable_stringtable = true;
  bool jumbo_message = false;  ///< messages up to 100 MiB
  /// Accepted, without effect.
  bool local_tap_enable = false;
  /// Accepted, without effect.
  std::string local_tap_name{};
  /// Further origins of pages that may use web sockets, besides WebSocketOptions::origins.
  std::vector<std::string> tcp_ws_add_origin{};
  /// Origins that are taken out of WebSocketOptions::origins.
  std::vector<std::string> tcp_ws_remove_origin{};
  bool tcp_ws_allow_local_pages = false;  ///< WebSocketOptions::allow_local_pages
  /// Serves the page of the inspector at the TCP port: WebSocketOptions::inspector_page.
  bool web_inspector = false;
  /// Its file; empty: the one that is installed with the runtime.
  std::string web_inspector_page{};
  /// Counts, and answers `GET /metrics` and `GET /health`: MetricsOptions::is_enabled.
  bool metrics = false;
  std::vector<std::string> metrics_from{};  ///< besides MetricsOptions::from
  std::vector<std::string> metrics_host{};  ///< besides MetricsOptions::hosts
  /// Reports of this level and above go to standard error, or to `log_file`, unless `node.log` or
  /// `node.log_record` takes them. One of `debug`, `info`, `warning`, `error`, and `disable`.
  std::string log_level = "warning";
  /// How a line on standard error looks: `text` or `logfmt` (LogFormat).
  std::string log_format = "text";
  /// A file for these reports instead of standard error (LogFile); empty: none.
  std::string log_file{};
  std::uint64_t log_file_size = 16 * 1024 * 1024;  ///< LogFile::Options::max_size
  std::uint64_t log_file_count = 5;                ///< LogFile::Options::kept_files

  /// The defaults of a client: listens to discovery, and to nothing else.
  static SetupOptions client();
  /// Those of a service: accepts connections by TCP from this machine, by local sockets and inside
  /// the process, and announces what others can reach. Its id is kept by its name, unless it has a
  /// certificate.
  static SetupOptions server(std::string name, std::uint16_t port);
  /// The same with TLS required.
  static SetupOptions secure_server(std::string name, std::uint16_t port);

  /// Takes in the configuration file, if one is named, the environment, and the arguments behind
  /// the program's name; returns those that are no flags of these. Throws rr::Error:
  /// invalid_argument for a flag that there is not and for a value that is none,
  /// invalid_configuration, with the line, for the same in the file, and for one that cannot be
  /// read.
  std::vector<std::string> take(int argc, const char* const* argv);
};

/// A node, set up; it is shut down with this. Where it listens is reported once, at level info, or
/// to standard error where `node.log` is not given and the level is `warning` or below.
///
///   int main(int argc, char** argv) {
///     rr::ServerNodeSetup setup("my.camera.host", 6257, argc, argv);
///     setup->register_service("camera", std::make_shared<MyCamera>());
///     rr::print_candidate_urls(std::cout, setup.node(), "camera");
///     setup.wait();
///   }
///
/// Nodes that a channel is missing for say so in their log, and go on; but not those that require
/// TLS.
class NodeSetup {
 public:
  /// Throws rr::Error: invalid_argument for wrong flags, invalid_operation when the name is in use
  /// by another node of this user, invalid_configuration for files of TLS that are missing or
  /// cannot be used, connection_error when it cannot listen, and others.
  explicit NodeSetup(SetupOptions options, int argc = 0, const char* const* argv = nullptr);
  ~NodeSetup();
  NodeSetup(const NodeSetup&) = delete;
  NodeSetup& operator=(const NodeSetup&) = delete;

  /// The node that was set up.
  [[nodiscard]] Node& node() const;
  /// The node: `setup->register_service(...)`.
  Node* operator->() const { return &node(); }
  /// As they have come to be.
  [[nodiscard]] const SetupOptions& options() const;
  /// What was no flag, without the program's name.
  [[nodiscard]] const std::vector<std::string>& arguments() const;
  /// Where it accepts connections by TCP; 0 for nowhere.
  [[nodiscard]] std::uint16_t port() const;

  /// Serves until SIGTERM or SIGINT comes, or end_wait() is called: returns the signal, 0 for
  /// end_wait(). Before and after, the signals do what they did. Under systemd it says when the
  /// service is ready and when it stops, and feeds the watchdog for as long as the node's threads
  /// do their work (docs/howto/setup.md#systemd). One thread at a time in the process; throws
  /// rr::Error (invalid_operation) for a second one.
  int wait();
  /// Ends wait(), also one that has not begun. Any thread.
  void end_wait();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A node with SetupOptions::client().
class ClientNodeSetup : public NodeSetup {
 public:
  /// Throws as NodeSetup.
  explicit ClientNodeSetup(int argc = 0, const char* const* argv = nullptr)
      : NodeSetup(SetupOptions::client(), argc, argv) {}
};

/// A node with SetupOptions::server().
class ServerNodeSetup : public NodeSetup {
 public:
  /// Port 0 means any. Throws as NodeSetup.
  ServerNodeSetup(std::string name, std::uint16_t port, int argc = 0,
                  const char* const* argv = nullptr)
      : NodeSetup(SetupOptions::server(std::move(name), port), argc, argv) {}
};

/// A node with SetupOptions::secure_server(): nothing but TLS.
class SecureServerNodeSetup : public NodeSetup {
 public:
  /// Port 0 means any. Throws as NodeSetup.
  SecureServerNodeSetup(std::string name, std::uint16_t port, int argc = 0,
                        const char* const* argv = nullptr)
      : NodeSetup(SetupOptions::secure_server(std::move(name), port), argc, argv) {}
};

/// The page of the inspector that is installed with the runtime, compressed by gzip: beside the
/// program, as `../share/robdef/inspector.html.gz`, or where the runtime was installed. The page
/// itself is beside it, without `.gz`. Throws rr::Error (invalid_configuration) where it is not.
std::string installed_inspector_page();

/// Tells the service manager something of the process, as systemd's sd_notify() does: lines such as
/// `STATUS=...`. False without a service manager (no `NOTIFY_SOCKET`), or when it fails.
/// NodeSetup:: wait() says READY, STOPPING and WATCHDOG by itself.
bool notify_service_manager(std::string_view lines);

/// All URLs by which a service of the node may be reached, one a line.
void print_candidate_urls(std::ostream& out, const Node& node, std::string_view service);

}  // namespace rr
