// SPDX-License-Identifier: Apache-2.0
#include "rr/url.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/texts.hpp"

namespace rr {
namespace {

[[noreturn]] void refuse(std::string_view url, const char* why) {
  throw Error(ErrorCode::invalid_argument, "`" + std::string(url) + "` is no URL of a service: " +
                                               why + "; " + channel::url_example);
}

std::optional<std::uint16_t> default_port(std::string_view scheme) {
  if (scheme == "rr+tcp" || scheme == "rrs+tcp") return 48653;
  if (scheme == "rr+ws" || scheme == "rrs+ws") return 80;
  if (scheme == "rr+wss" || scheme == "rrs+wss") return 443;
  return std::nullopt;
}

int hexadecimal(char c) {
  if (channel::is_digit(c)) return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string percent_decode(std::string_view url, std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      decoded.push_back(text[i]);
      continue;
    }
    const int high = i + 2 < text.size() ? hexadecimal(text[i + 1]) : -1;
    const int low = i + 2 < text.size() ? hexadecimal(text[i + 2]) : -1;
    if (high < 0 || low < 0) refuse(url, "a `%` needs two hexadecimal digits");
    decoded.push_back(static_cast<char>(high * 16 + low));
    i += 2;
  }
  return decoded;
}

// `host`, `host:port`, `[v6]:port`.
void read_authority(std::string_view url, std::string_view text, Url& result, bool& has_port) {
  std::string_view port;
  if (text.starts_with('[')) {
    const std::size_t end = text.find(']');
    if (end == std::string_view::npos) refuse(url, "the `[` of the address is not closed");
    result.host = text.substr(1, end - 1);
    text.remove_prefix(end + 1);
    if (!text.empty() && text.front() != ':') refuse(url, "only a port may follow the `]`");
    has_port = !text.empty();
    port = has_port ? text.substr(1) : text;
  } else {
    const std::size_t colon = text.rfind(':');
    has_port = colon != std::string_view::npos;
    result.host = text.substr(0, colon);
    if (has_port) port = text.substr(colon + 1);
    if (result.host.find(':') != std::string::npos) refuse(url, "an IPv6 address needs brackets");
  }
  if (!has_port) return;
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), result.port);
  if (error != std::errc() || end != port.data() + port.size())
    refuse(url, "the port is no number");
}

// One name of a node as it may stand in a URL: a UUID or a node name.
void read_node(std::string_view url, std::string_view text, Url& result) {
  if (const auto id = NodeId::parse(text)) {
    result.node_id = *id;
  } else if (Url::is_node_name(text)) {
    result.node_name = text;
  } else {
    refuse(url, "the node is neither a node id nor a node name");
  }
}

void read_query(std::string_view url, Url& result) {
  bool has_service = false;
  bool has_id = false;
  bool has_name = false;
  std::string_view rest = result.query;
  while (!rest.empty()) {
    const std::size_t end = rest.find('&');
    const std::string_view item = rest.substr(0, end);
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
    const std::size_t equals = item.find('=');
    if (equals == std::string_view::npos || item.find('=', equals + 1) != std::string_view::npos) {
      refuse(url, "each parameter needs one `=`");
    }
    const std::string_view key = item.substr(0, equals);
    std::string value = percent_decode(url, item.substr(equals + 1));
    if (key == "service" && !has_service) {
      has_service = true;
      result.service = std::move(value);
    } else if (key == "nodeid" && !has_id) {
      has_id = true;
      const auto id = NodeId::parse(value);
      if (!id) refuse(url, "the node id is no UUID");
      result.node_id = *id;
    } else if (key == "nodename" && !has_name) {
      has_name = true;
      if (!Url::is_node_name(value)) refuse(url, "the node name is not well formed");
      result.node_name = std::move(value);
    }
  }
}

// `/<node>/<service>`, of 2011.
void read_legacy_path(std::string_view url, Url& result) {
  const std::string_view path = result.path;
  const std::size_t slash = path.empty() ? std::string_view::npos : path.find('/', 1);
  if (slash == std::string_view::npos) {
    if (path.size() > 1) refuse(url, "the path needs a node and a service");
    return;
  }
  std::string_view service = path.substr(slash + 1);
  if (service.ends_with('/')) service.remove_suffix(1);
  if (service.empty() || service.find('/') != std::string_view::npos) {
    refuse(url, "the path needs a node and a service");
  }
  result.service = percent_decode(url, service);
  const std::string node = percent_decode(url, path.substr(1, slash - 1));
  if (!node.empty()) read_node(url, node, result);
}

}  // namespace

bool Url::is_node_name(std::string_view text) {
  if (text.empty() || text.size() > 1024 || !channel::is_letter(text.front())) return false;
  return std::all_of(text.begin(), text.end(), [](char c) {
    return channel::is_letter(c) || channel::is_digit(c) || c == '_' || c == '.' || c == '-';
  });
}

Url Url::parse(std::string_view text) {
  Url result;
  const std::size_t scheme_end = text.find("://");
  if (scheme_end == std::string_view::npos || scheme_end == 0) refuse(text, "it has no scheme");
  result.scheme = text.substr(0, scheme_end);
  std::transform(result.scheme.begin(), result.scheme.end(), result.scheme.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  std::string_view rest = text.substr(scheme_end + 3);
  const std::size_t authority_end = rest.find_first_of("/?");
  const std::string_view authority = rest.substr(0, authority_end);
  rest = authority_end == std::string_view::npos ? std::string_view() : rest.substr(authority_end);
  const std::size_t question = rest.find('?');
  result.path = rest.substr(0, question);
  if (question != std::string_view::npos) result.query = rest.substr(question + 1);
  if (result.query.find('#') != std::string::npos || result.path.find('#') != std::string::npos) {
    refuse(text, "it has a fragment");
  }

  bool has_port = false;
  read_authority(text, authority, result, has_port);
  if (!has_port) result.port = default_port(result.scheme).value_or(0);
  if (result.scheme == "tcp") {
    if (!has_port) refuse(text, "it needs a port");
    read_legacy_path(text, result);
    return result;
  }
  if ((result.scheme == "rr+tcp" || result.scheme == "rrs+tcp") && result.path.size() > 1) {
    refuse(text, "only `/` may stand before the `?`");
  }
  if (result.scheme == "rr+local" && has_port) refuse(text, "a local service has no port");
  read_query(text, result);
  return result;
}

}  // namespace rr
