// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/remote_address.hpp"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cstring>

#include "runtime/cpp/src/channel/socket.hpp"

namespace rr::channel {
namespace {

std::string ip_text(const sockaddr_storage& storage, socklen_t size) {
  if (storage.ss_family == AF_INET6) {
    const auto& v6 = reinterpret_cast<const sockaddr_in6&>(storage);
    if (IN6_IS_ADDR_V4MAPPED(&v6.sin6_addr)) {
      std::array<char, INET_ADDRSTRLEN> text{};
      const void* const v4 = v6.sin6_addr.s6_addr + 12;
      return inet_ntop(AF_INET, v4, text.data(), text.size()) == nullptr ? "" : text.data();
    }
  }
  std::array<char, NI_MAXHOST> host{};
  if (getnameinfo(reinterpret_cast<const sockaddr*>(&storage), size, host.data(), host.size(),
                  nullptr, 0, NI_NUMERICHOST) != 0) {
    return {};
  }
  return host.data();
}

}  // namespace

std::string remote_address_of(int descriptor) {
  sockaddr_storage storage{};
  socklen_t size = sizeof storage;
  if (getpeername(descriptor, reinterpret_cast<sockaddr*>(&storage), &size) != 0) return {};
  if (storage.ss_family == AF_INET || storage.ss_family == AF_INET6) return ip_text(storage, size);
  if (storage.ss_family != AF_UNIX) return {};
  const auto user = peer_user(descriptor);
  return user ? "uid " + std::to_string(*user) : std::string();
}

std::string remote_key(std::string_view remote_address) {
  const std::string digits(remote_address.substr(0, remote_address.find('%')));
  in6_addr address{};
  if (inet_pton(AF_INET6, digits.c_str(), &address) != 1) return std::string(remote_address);
  std::memset(address.s6_addr + 8, 0, 8);
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (inet_ntop(AF_INET6, &address, text.data(), text.size()) == nullptr) return digits;
  return std::string(text.data()) + "/64";
}

}  // namespace rr::channel
