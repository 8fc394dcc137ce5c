// SPDX-License-Identifier: Apache-2.0
#include "rr/setup.hpp"

#include <array>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <ostream>
#include <utility>

#include "rr/error.hpp"
#include "rr/wire.hpp"
#include "runtime/cpp/src/channel/components.hpp"
#include "runtime/cpp/src/channel/logging.hpp"
#include "runtime/cpp/src/node/end_of_service.hpp"
#include "runtime/cpp/src/node/kept_node_id.hpp"
#include "runtime/cpp/src/platform/node_folders.hpp"
#include "runtime/cpp/src/platform/service_manager.hpp"

namespace rr {
namespace {

// The most that the protocol allows (04, section 3).
constexpr std::uint32_t jumbo_size = 100 * 1024 * 1024;

constexpr const char* private_local_url = "rr+local:///";
constexpr const char* public_local_url = "rr+local:///?public=true";

// The least level that is reported; nothing for none.
std::optional<LogLevel> least_level(const std::string& name) {
  for (const LogLevel level :
       {LogLevel::debug, LogLevel::info, LogLevel::warning, LogLevel::error}) {
    if (log_level_name(level) == name) return level;
  }
  return std::nullopt;
}

// A log for a program that has none of its own.
void apply_log(const SetupOptions& setup, NodeOptions& options) {
  const auto least = least_level(setup.log_level);
  if (options.log || options.log_record || !least) return;
  if (!setup.log_file.empty()) {
    options.log_record =
        LogFile(setup.log_file, {.least = *least,
                                 .max_size = setup.log_file_size,
                                 .kept_files = static_cast<unsigned>(setup.log_file_count)});
  } else {
    options.log_record =
        StderrLog(*least, setup.log_format == "logfmt" ? LogFormat::logfmt : LogFormat::text);
  }
}

void apply_limits(const SetupOptions& setup, NodeOptions& options) {
  if (setup.disable_timeouts) {
    constexpr auto never = std::chrono::milliseconds::max();
    options.request_timeout = options.receive_timeout = options.client_timeout = never;
    options.generator_timeout = never;
  }
  if (setup.disable_message4) {
    options.client_offer.message_v4 = options.server_offer.message_v4 = false;
  }
  if (setup.disable_stringtable || setup.disable_message4) {
    options.client_offer.string_table = options.server_offer.string_table = false;
  }
  if (setup.jumbo_message) options.limits.message_size = jumbo_size;
}

void append(std::vector<std::string>& to, const std::vector<std::string>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

void apply_tls(const SetupOptions& setup, TlsOptions& tls) {
  tls.is_required = tls.is_required || setup.require_tls;
  if (!setup.tls_certificate.empty()) {
    tls.certificate_file = setup.tls_certificate;
    tls.key_file.clear();
  }
  if (!setup.tls_key.empty()) tls.key_file = setup.tls_key;
  append(tls.authority_files, setup.tls_authority);
  append(tls.revocation_files, setup.tls_revocation);
}

// Where the existing implementations keep the certificate of a node.
std::string certificate_of(const NodeId& id) {
  const auto folder = platform::node_folders().user_config / "certificates";
  for (const std::string& name : {id.text(), id.text_with_braces()}) {
    std::error_code error;
    const auto file = folder / (name + ".p12");
    if (std::filesystem::exists(file, error)) return file.string();
  }
  throw Error(ErrorCode::invalid_configuration,
              "`load-tls` needs a certificate: give `tls-certificate`, or put it at `" +
                  (folder / (id.text() + ".p12")).string() + "`");
}

void apply_channels(const SetupOptions& setup, NodeOptions& options) {
  std::vector<std::string>& origins = options.web_socket.origins;
  append(origins, setup.tcp_ws_add_origin);
  if (setup.tcp_ws_allow_local_pages) options.web_socket.allow_local_pages = true;
  for (const std::string& origin : setup.tcp_ws_remove_origin) std::erase(origins, origin);
  if (setup.web_inspector) {
    options.web_socket.inspector_page =
        setup.web_inspector_page.empty() ? installed_inspector_page() : setup.web_inspector_page;
  }
}

void apply_metrics(const SetupOptions& setup, MetricsOptions& metrics) {
  metrics.is_enabled = metrics.is_enabled || setup.metrics;
  append(metrics.from, setup.metrics_from);
  append(metrics.hosts, setup.metrics_host);
}

// A channel whose flags a set-up knows, and what it does with them.
struct ChannelRow {
  bool (*is_wanted)(const SetupOptions&);
  std::string (*url)(const SetupOptions&);  ///< to listen at
  bool is_tcp = false;
};

// Those that are listened to.
constexpr std::array channels = {
    ChannelRow{[](const SetupOptions& setup) { return setup.tcp_enable && setup.tcp_start_server; },
               [](const SetupOptions& setup) {
                 const std::string host = setup.tcp_listen_localhost ? "localhost" : "*";
                 return "rr+tcp://" + host + ":" + std::to_string(setup.tcp_port);
               },
               true},
    ChannelRow{
        [](const SetupOptions& setup) { return setup.local_enable && setup.local_start_server; },
        [](const SetupOptions& setup) {
          return std::string(setup.local_server_public ? public_local_url : private_local_url);
        }},
    ChannelRow{
        [](const SetupOptions& setup) { return setup.intra_enable && setup.intra_start_server; },
        [](const SetupOptions&) { return std::string("rr+intra:///"); }},
};

// Most machines have no folder for public local sockets, for which an administrator is needed: the
// user's own is used instead.
std::uint16_t listen(Node& node, const std::string& url, const NodeOptions& options) {
  try {
    return node.listen(url);
  } catch (const Error& error) {
    if (url != public_local_url || error.code() != ErrorCode::system_resource_error) throw;
    channel::log(options, LogLevel::info,
                 "local sockets are for this user only: " + error.message());
  }
  return node.listen(private_local_url);
}

// What may be asked for, and nobody here does.
void report_missing(const SetupOptions& setup, const NodeOptions& options) {
  const auto warn = [&](const char* flag, const char* why) {
    channel::log(options, LogLevel::warning,
                 "the flag " + std::string(flag) + " does nothing: " + why);
  };
  if (setup.hardware_enable) warn("hardware-enable", "there are no channels to hardware");
  if (setup.local_tap_enable) {
    warn("local-tap-enable", "messages are recorded by NodeOptions::tap");
  }
}

bool has_kept_name(const SetupOptions& setup) {
  const bool is_local = setup.local_start_server || setup.local_start_client;
  return !setup.node.name.empty() && setup.node.id.is_any() && setup.local_enable && is_local;
}

// A certificate says who the node is; without one its name does.
std::optional<KeptNodeId> choose_id(SetupOptions& setup) {
  TlsOptions& tls = setup.node.tls;
  apply_tls(setup, tls);
  const bool is_certified = !tls.certificate_file.empty();
  const bool is_kept = has_kept_name(setup);
  std::optional<KeptNodeId> kept;
  if (is_certified && setup.node.id.is_any()) setup.node.id = channel::certified_id(tls);
  if (is_kept && is_certified) {
    kept.emplace(setup.node.name, setup.node.id);
  } else if (is_kept) {
    kept.emplace(setup.node.name);
    setup.node.id = kept->id();
  }
  if (!is_certified && setup.load_tls) {
    if (setup.node.id.is_any()) {
      throw Error(ErrorCode::invalid_configuration,
                  "`load-tls` needs a certificate: give `tls-certificate`");
    }
    tls.certificate_file = certificate_of(setup.node.id);
  }
  setup.load_tls = !tls.certificate_file.empty();
  setup.require_tls = tls.is_required;
  return kept;
}

// One line: who can connect, and how to change that.
std::string place_line(const SetupOptions& setup, std::uint16_t port) {
  const std::string at = "port " + std::to_string(port);
  const std::string how = setup.require_tls ? ", with TLS only" : "";
  if (setup.tcp_listen_localhost) {
    return "listens at " + at + " of the loopback interface" + how +
           "; --robotraconteur-tcp-listen-localhost=false opens it to other machines";
  }
  return "listens at " + at + " of all interfaces" + how +
         "; --robotraconteur-tcp-listen-localhost=true keeps it to this machine";
}

void report_place(const SetupOptions& setup, const NodeOptions& options, std::uint16_t port) {
  const std::string line = place_line(setup, port);
  if (setup.node.log || setup.node.log_record) {
    channel::log(options, LogLevel::info, line);
  } else if (setup.log_level == "error" || setup.log_level == "disable") {
    return;
  } else if (setup.log_format == "logfmt") {
    NodeOptions told;
    told.id = options.id;
    told.name = options.name;
    told.log_record = StderrLog(LogLevel::info, LogFormat::logfmt);
    channel::log(told, LogLevel::info, line);
  } else {
    const std::string whole = "robotraconteur: " + line + "\n";
    std::fwrite(whole.data(), 1, whole.size(), stderr);
  }
}

DiscoveryNetwork network_of(const SetupOptions& setup) {
  return {.link_local = setup.tcp_ipv6_discovery, .ipv4_broadcast = setup.tcp_ipv4_discovery};
}

}  // namespace

struct NodeSetup::State {
  SetupOptions options;
  std::vector<std::string> arguments;
  std::optional<KeptNodeId> kept_id;  // goes after the node
  std::optional<Node> node;
  std::uint16_t port = 0;
  EndOfService end;
};

NodeSetup::NodeSetup(SetupOptions options, int argc, const char* const* argv)
    : state_(std::make_unique<State>()) {
  State& state = *state_;
  state.options = std::move(options);
  SetupOptions& setup = state.options;
  state.arguments = setup.take(argc, argv);
  state.kept_id = choose_id(setup);
  NodeOptions node_options = setup.node;
  apply_log(setup, node_options);
  apply_limits(setup, node_options);
  apply_channels(setup, node_options);
  apply_metrics(setup, node_options.metrics);
  report_missing(setup, node_options);
  state.node.emplace(node_options);
  Node& node = *state.node;
  setup.node.id = node_options.id = node.id();

  for (const ChannelRow& row : channels) {
    if (!row.is_wanted(setup)) continue;
    const std::uint16_t port = listen(node, row.url(setup), node_options);
    if (!row.is_tcp) continue;
    state.port = port;
    report_place(setup, node_options, port);
  }
  const Discovery discovery = node.discovery();
  const bool has_network = setup.tcp_ipv4_discovery || setup.tcp_ipv6_discovery;
  if (setup.tcp_enable && setup.discovery_announce_enable && has_network) {
    discovery.announce({.network = network_of(setup)});
  }
  if (setup.discovery_listening_enable) {
    // Another program may hold the port for itself; the node works without discovery.
    try {
      discovery.listen({.network = network_of(setup), .local = setup.local_enable});
    } catch (const Error& error) {
      channel::log(node_options, LogLevel::warning, error.message());
    }
  }
}

NodeSetup::~NodeSetup() = default;

Node& NodeSetup::node() const { return *state_->node; }
const SetupOptions& NodeSetup::options() const { return state_->options; }
const std::vector<std::string>& NodeSetup::arguments() const { return state_->arguments; }
std::uint16_t NodeSetup::port() const { return state_->port; }
int NodeSetup::wait() { return state_->end.wait(*state_->node); }
void NodeSetup::end_wait() { state_->end.request(); }
bool notify_service_manager(std::string_view lines) {
  return platform::notify_service_manager(lines);
}

void print_candidate_urls(std::ostream& out, const Node& node, std::string_view service) {
  for (const std::string& url : node.candidate_urls(service)) out << url << '\n';
}

}  // namespace rr
