// SPDX-License-Identifier: Apache-2.0
// The flags of a node's set-up: one table, read for the command line, for the environment and for
// the configuration file.
#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "rr/error.hpp"
#include "rr/setup.hpp"
#include "rr/url.hpp"
#include "runtime/cpp/src/node/setup_file.hpp"

namespace rr {
namespace {

constexpr std::string_view prefix = "--robotraconteur-";

using Switch = bool SetupOptions::*;
using Text = std::string SetupOptions::*;
using Texts = std::vector<std::string> SetupOptions::*;
/// Returns false for a value that is none.
using Taker = bool (*)(SetupOptions&, const std::string&);

struct Flag {
  std::string_view name;  ///< behind the prefix
  std::variant<Switch, Text, Texts, Taker> target;
};

bool take_name(SetupOptions& options, const std::string& value) {
  options.node.name = value;
  return Url::is_node_name(value);
}

bool take_id(SetupOptions& options, const std::string& value) {
  const auto id = NodeId::parse(value);
  if (id) options.node.id = *id;
  return id.has_value();
}

bool take_port(SetupOptions& options, const std::string& value) {
  const char* const end = value.data() + value.size();
  const auto [stop, error] = std::from_chars(value.data(), end, options.tcp_port);
  return !value.empty() && error == std::errc() && stop == end;
}

bool take_level(SetupOptions& options, const std::string& value) {
  std::string level = value;
  std::transform(level.begin(), level.end(), level.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (level == "trace") level = "debug";
  if (level == "fatal") level = "error";
  options.log_level = level;
  constexpr std::array levels = {"debug", "info", "warning", "error", "disable"};
  return std::find(levels.begin(), levels.end(), level) != levels.end();
}

bool take_format(SetupOptions& options, const std::string& value) {
  options.log_format = value;
  return value == "text" || value == "logfmt";
}

bool take_number(std::uint64_t& to, const std::string& value) {
  const char* const end = value.data() + value.size();
  const auto [stop, error] = std::from_chars(value.data(), end, to);
  return !value.empty() && error == std::errc() && stop == end;
}

bool take_file_size(SetupOptions& options, const std::string& value) {
  return take_number(options.log_file_size, value) && options.log_file_size != 0;
}

bool take_file_count(SetupOptions& options, const std::string& value) {
  constexpr std::uint64_t most = 1000;  // each is renamed when one is full
  return take_number(options.log_file_count, value) && options.log_file_count <= most;
}

std::optional<bool> truth_of(const std::string& value) {
  if (value == "true" || value == "1") return true;
  if (value == "false" || value == "0") return false;
  return std::nullopt;
}

bool take_shared_memory(SetupOptions& options, const std::string& value) {
  const auto truth = truth_of(value);
  if (truth) options.node.local.shared_memory = *truth;
  return truth.has_value();
}

bool take_system_trust(SetupOptions& options, const std::string& value) {
  const auto truth = truth_of(value);
  if (truth) options.node.tls.trust_system_authorities = truth;
  return truth.has_value();
}

// The file is read before everything else (config_file()).
bool take_config(SetupOptions& /*options*/, const std::string& value) { return !value.empty(); }

using O = SetupOptions;
const std::array flags = {
    Flag{"config", &take_config},
    Flag{"discovery-listening-enable", &O::discovery_listening_enable},
    Flag{"discovery-announce-enable", &O::discovery_announce_enable},
    Flag{"local-enable", &O::local_enable},
    Flag{"tcp-enable", &O::tcp_enable},
    Flag{"hardware-enable", &O::hardware_enable},
    Flag{"intra-enable", &O::intra_enable},
    Flag{"local-start-server", &O::local_start_server},
    Flag{"local-start-client", &O::local_start_client},
    Flag{"local-server-public", &O::local_server_public},
    Flag{"local-shared-memory", &take_shared_memory},
    Flag{"tcp-start-server", &O::tcp_start_server},
    Flag{"tcp-listen-localhost", &O::tcp_listen_localhost},
    Flag{"tcp-start-server-sharer", &O::tcp_start_server_sharer},
    Flag{"tcp-ws-add-origin", &O::tcp_ws_add_origin},
    Flag{"tcp-ws-remove-origin", &O::tcp_ws_remove_origin},
    Flag{"tcp-ws-allow-local-pages", &O::tcp_ws_allow_local_pages},
    Flag{"web-inspector", &O::web_inspector},
    Flag{"web-inspector-page", &O::web_inspector_page},
    Flag{"tcp-ipv4-discovery", &O::tcp_ipv4_discovery},
    Flag{"tcp-ipv6-discovery", &O::tcp_ipv6_discovery},
    Flag{"intra-start-server", &O::intra_start_server},
    Flag{"disable-timeouts", &O::disable_timeouts},
    Flag{"disable-message4", &O::disable_message4},
    Flag{"disable-stringtable", &O::disable_stringtable},
    Flag{"load-tls", &O::load_tls},
    Flag{"require-tls", &O::require_tls},
    Flag{"tls-certificate", &O::tls_certificate},
    Flag{"tls-key", &O::tls_key},
    Flag{"tls-authority", &O::tls_authority},
    Flag{"tls-revocation", &O::tls_revocation},
    Flag{"tls-trust-system-authorities", &take_system_trust},
    Flag{"nodeid", &take_id},
    Flag{"nodename", &take_name},
    Flag{"tcp-port", &take_port},
    Flag{"log-level", &take_level},
    Flag{"log-format", &take_format},
    Flag{"log-file", &O::log_file},
    Flag{"log-file-size", &take_file_size},
    Flag{"log-file-count", &take_file_count},
    Flag{"metrics", &O::metrics},
    Flag{"metrics-from", &O::metrics_from},
    Flag{"metrics-host", &O::metrics_host},
    Flag{"local-tap-enable", &O::local_tap_enable},
    Flag{"local-tap-name", &O::local_tap_name},
    Flag{"jumbo-message", &O::jumbo_message},
};

bool take_value(SetupOptions& options, const Flag& flag, const std::string& value) {
  if (const auto* taker = std::get_if<Taker>(&flag.target)) return (*taker)(options, value);
  if (const auto* text = std::get_if<Text>(&flag.target)) {
    options.*(*text) = value;
    return true;
  }
  if (const auto* texts = std::get_if<Texts>(&flag.target)) {
    (options.*(*texts)).push_back(value);
    return true;
  }
  const auto truth = truth_of(value);
  if (truth) options.*std::get<Switch>(flag.target) = *truth;
  return truth.has_value();
}

void take_named(SetupOptions& options, const Flag& flag, const std::string& written,
                const std::string& value) {
  if (take_value(options, flag, value)) return;
  throw Error(ErrorCode::invalid_argument, "`" + value + "` is no value for `" + written + "`");
}

std::string variable_of(const Flag& flag) {
  std::string name = "ROBOTRACONTEUR_";
  for (const char c : flag.name) {
    name += c == '-' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  return name;
}

const Flag* flag_of(std::string_view name) {
  for (const Flag& flag : flags) {
    if (flag.name == name) return &flag;
  }
  return nullptr;
}

const Flag& find_flag(const std::string& written, std::string_view name) {
  const Flag* const flag = flag_of(name);
  if (flag == nullptr) {
    throw Error(ErrorCode::invalid_argument, "there is no flag `" + written + "`");
  }
  return *flag;
}

// The configuration file that the command line names or, if it does not, the environment; empty:
// none.
std::string config_file(int argc, const char* const* argv) {
  constexpr std::string_view name = "--robotraconteur-config";
  std::string file;
  if (const char* const variable = std::getenv("ROBOTRACONTEUR_CONFIG")) file = variable;
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument == "--") break;
    if (argument == name && i + 1 < argc) file = argv[i + 1];
    if (argument.starts_with(name) && argument.substr(name.size()).starts_with('=')) {
      file = argument.substr(name.size() + 1);
    }
  }
  return file;
}

void take_file(SetupOptions& options, const std::string& path) {
  for (const SetupLine& line : read_setup_file(path)) {
    const Flag* const flag = flag_of(line.name);
    const bool is_known = flag != nullptr && flag->name != "config";
    if (is_known && take_value(options, *flag, line.value)) continue;
    throw Error(
        ErrorCode::invalid_configuration,
        line.place + (is_known ? ": `" + line.value + "` is no value for `" + line.name + "`"
                               : ": there is no setting `" + line.name + "`"));
  }
}

}  // namespace

SetupOptions SetupOptions::client() { return {}; }

SetupOptions SetupOptions::server(std::string name, std::uint16_t port) {
  SetupOptions options;
  options.node.name = std::move(name);
  options.tcp_port = port;
  options.discovery_announce_enable = true;
  options.local_start_server = true;
  options.local_server_public = true;
  options.tcp_start_server = true;
  options.tcp_start_server_sharer = true;
  options.intra_start_server = true;
  return options;
}

SetupOptions SetupOptions::secure_server(std::string name, std::uint16_t port) {
  SetupOptions options = server(std::move(name), port);
  options.load_tls = true;
  options.require_tls = true;
  return options;
}

std::vector<std::string> SetupOptions::take(int argc, const char* const* argv) {
  if (const std::string file = config_file(argc, argv); !file.empty()) take_file(*this, file);
  for (const Flag& flag : flags) {
    const std::string name = variable_of(flag);
    const char* const value = std::getenv(name.c_str());
    if (value != nullptr && *value != '\0') take_named(*this, flag, name, value);
  }
  std::vector<std::string> left;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--") {
      left.insert(left.end(), argv + i, argv + argc);
      break;
    }
    if (!argument.starts_with(prefix)) {
      left.push_back(argument);
      continue;
    }
    const std::size_t equals = argument.find('=');
    const std::string written = argument.substr(0, equals);
    const Flag& flag = find_flag(written, std::string_view(written).substr(prefix.size()));
    if (equals != std::string::npos) {
      take_named(*this, flag, written, argument.substr(equals + 1));
    } else if (std::holds_alternative<Switch>(flag.target)) {
      take_named(*this, flag, written, "true");
    } else if (i + 1 < argc) {
      take_named(*this, flag, written, argv[++i]);
    } else {
      throw Error(ErrorCode::invalid_argument, "`" + written + "` needs a value");
    }
  }
  return left;
}

}  // namespace rr
