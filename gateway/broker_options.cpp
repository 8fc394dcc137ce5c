// SPDX-License-Identifier: Apache-2.0
#include "gateway/broker_options.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

#include "rr/error.hpp"

namespace rr::gateway {
namespace {

std::optional<int> port_of(std::string_view text) {
  int port = 0;
  const char* const end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, port);
  const bool is_port = result.ec == std::errc() && result.ptr == end && port > 0 && port < 65'536;
  return is_port ? std::optional(port) : std::nullopt;
}

/// `host`, `host:port`, `[address]`, `[address]:port`. False for anything else.
bool read_host(std::string_view text, BrokerPlace& place) {
  std::string_view after;
  if (text.starts_with('[')) {
    const std::size_t close = text.find(']');
    if (close == std::string_view::npos) return false;
    place.host = text.substr(1, close - 1);
    after = text.substr(close + 1);
  } else {
    const std::size_t colon = text.find(':');
    place.host = text.substr(0, colon);
    if (colon != std::string_view::npos) after = text.substr(colon);
  }
  if (place.host.empty() || place.host.find_first_of("/@") != std::string::npos) return false;
  if (after.empty()) return true;
  const auto port = after.starts_with(':') ? port_of(after.substr(1)) : std::nullopt;
  if (port) place.port = *port;
  return port.has_value();
}

}  // namespace

bool has_scheme(std::string_view url, std::string_view scheme) {
  return url.starts_with(scheme) && url.substr(scheme.size()).starts_with("://");
}

BrokerPlace place_of(const BrokerOptions& broker, std::span<const BrokerScheme> schemes) {
  const auto scheme = std::ranges::find_if(
      schemes, [&](const BrokerScheme& each) { return has_scheme(broker.url, each.name); });
  BrokerPlace place;
  if (scheme != schemes.end()) {
    place = {scheme->is_encrypted, {}, scheme->port};
    const auto rest = std::string_view(broker.url).substr(scheme->name.size() + 3);
    if (read_host(rest, place)) {
      const bool has_files =
          !broker.authority.empty() || !broker.certificate.empty() || !broker.key.empty();
      if (place.is_encrypted || !has_files) return place;
      throw Error(ErrorCode::invalid_argument,
                  "`" + broker.url + "` is not encrypted: `authority`, `certificate` and `key` " +
                      "are for TLS");
    }
  }
  std::string forms;
  for (const BrokerScheme& each : schemes) {
    forms += (forms.empty() ? "" : " or ") + std::string(each.name) + "://host:port";
  }
  throw Error(ErrorCode::invalid_argument, "`" + broker.url + "` is not of the form " + forms);
}

}  // namespace rr::gateway
