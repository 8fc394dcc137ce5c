// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/remote_address.hpp"

#include <algorithm>

#include "runtime/cpp/src/channel/socket.hpp"

namespace rr::channel {
std::string remote_address_of(int socket) {
  const Address address = platform::remote_address(socket);
  if (const auto ip = address.ip()) {
    return ip->is_v4_in_v6() ? ip->as_v4().text() : address.host();
  }
  if (address.family() != Family::local) return {};
  const auto user = platform::peer_user(socket);
  return user ? "uid " + std::to_string(*user) : std::string();
}

std::string remote_key(std::string_view remote_address) {
  auto ip = platform::parse_ip(std::string(remote_address.substr(0, remote_address.find('%'))));
  if (!ip || !ip->is_v6) return std::string(remote_address);
  std::fill(ip->bytes.begin() + 8, ip->bytes.end(), std::uint8_t{0});
  return ip->text() + "/64";
}

}  // namespace rr::channel
