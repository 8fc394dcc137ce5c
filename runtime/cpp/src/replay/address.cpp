// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/replay/address.hpp"

#include "rr/error.hpp"
#include "rr/url.hpp"

namespace rr::replay {

HostPort host_port_of(std::string_view text) {
  const auto refuse = [&](const char* why) {
    throw Error(ErrorCode::invalid_argument, "`" + std::string(text) + "` is " + why);
  };
  const bool is_url = text.find("://") != std::string_view::npos;
  const std::size_t colon = text.rfind(':');
  const std::size_t bracket = text.rfind(']');
  const bool has_port = colon != std::string_view::npos && colon + 1 != text.size() &&
                        (bracket == std::string_view::npos || colon > bracket);
  if (!is_url && !has_port) refuse("not HOST:PORT");
  const Url url = Url::parse(is_url ? std::string(text) : "rr+tcp://" + std::string(text) + "/");
  if (url.scheme != "rr+tcp" && url.scheme != "tcp") refuse("not over TCP");
  if (url.host.empty() || url.port == 0) refuse("not HOST:PORT");
  return {url.host, url.port};
}

}  // namespace rr::replay
