// SPDX-License-Identifier: Apache-2.0
// Addresses are laid out alike on all systems that have the sockets of BSD.
#include "runtime/cpp/src/platform/address.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>

#include "system_sockets.hpp"

namespace rr::platform {
namespace {

static_assert(sizeof(Address::bytes) == sizeof(sockaddr_storage) &&
              alignof(Address) >= alignof(sockaddr_storage));

template <class Kind>
Kind& as(Address& address) {
  return *reinterpret_cast<Kind*>(address.bytes.data());
}
template <class Kind>
const Kind& as(const Address& address) {
  return *reinterpret_cast<const Kind*>(address.bytes.data());
}

Address address_of(const sockaddr& system, std::size_t size) {
  Address address;
  address.size = static_cast<std::uint32_t>(std::min(size, address.bytes.size()));
  std::memcpy(address.bytes.data(), &system, address.size);
  return address;
}

int flags_of(LookUp how) {
  switch (how) {
    case LookUp::digits:
    case LookUp::own:
      return AI_NUMERICHOST;
    case LookUp::configured:
      return AI_ADDRCONFIG;
    case LookUp::everywhere:
      return AI_NUMERICHOST | AI_PASSIVE;
    case LookUp::all:
      break;
  }
  return 0;
}

}  // namespace

bool IpAddress::is_loopback() const {
  if (!is_v6) return bytes[0] == 127;
  return bytes[15] == 1 && std::count(bytes.begin(), bytes.end(), 0) == 15;
}

bool IpAddress::is_link_local() const {
  return is_v6 && bytes[0] == 0xfe && (bytes[1] & 0xc0) == 0x80;
}

bool IpAddress::is_v4_in_v6() const {
  constexpr std::ptrdiff_t zeros = 10;
  return is_v6 && std::count(bytes.begin(), bytes.begin() + zeros, 0) == zeros &&
         bytes[10] == 0xff && bytes[11] == 0xff;
}

IpAddress IpAddress::as_v4() const {
  IpAddress v4;
  std::copy(bytes.begin() + 12, bytes.end(), v4.bytes.begin());
  return v4;
}

std::string IpAddress::text() const {
  std::array<char, INET6_ADDRSTRLEN> text{};
  const int family = is_v6 ? AF_INET6 : AF_INET;
  const char* const written =
      inet_ntop(family, bytes.data(), text.data(), static_cast<socklen_t>(text.size()));
  return written == nullptr ? std::string() : written;
}

std::optional<IpAddress> parse_ip(const std::string& text) {
  IpAddress ip;
  if (inet_pton(AF_INET, text.c_str(), ip.bytes.data()) == 1) return ip;
  ip.is_v6 = true;
  if (inet_pton(AF_INET6, text.c_str(), ip.bytes.data()) == 1) return ip;
  return std::nullopt;
}

Family Address::family() const {
  if (size == 0) return Family::none;
  switch (as<sockaddr>(*this).sa_family) {
    case AF_INET:
      return Family::v4;
    case AF_INET6:
      return Family::v6;
    case AF_UNIX:
      return Family::local;
    default:
      return Family::none;
  }
}

std::optional<IpAddress> Address::ip() const {
  IpAddress ip;
  if (family() == Family::v4) {
    std::memcpy(ip.bytes.data(), &as<sockaddr_in>(*this).sin_addr, sizeof(in_addr));
    return ip;
  }
  if (family() != Family::v6) return std::nullopt;
  ip.is_v6 = true;
  std::memcpy(ip.bytes.data(), &as<sockaddr_in6>(*this).sin6_addr, sizeof(in6_addr));
  ip.scope = as<sockaddr_in6>(*this).sin6_scope_id;
  return ip;
}

std::uint16_t Address::port() const {
  return ntohs(family() == Family::v6 ? as<sockaddr_in6>(*this).sin6_port
                                      : as<sockaddr_in>(*this).sin_port);
}

void Address::set_port(std::uint16_t port) {
  if (family() == Family::v6) {
    as<sockaddr_in6>(*this).sin6_port = htons(port);
  } else {
    as<sockaddr_in>(*this).sin_port = htons(port);
  }
}

std::string Address::host() const {
  std::array<char, NI_MAXHOST> host{};
  if (getnameinfo(&as<sockaddr>(*this), static_cast<socklen_t>(size), host.data(), host.size(),
                  nullptr, 0, NI_NUMERICHOST) != 0) {
    return {};
  }
  return host.data();
}

std::string Address::text() const {
  if (family() == Family::local) return as<sockaddr_un>(*this).sun_path;
  const std::string name = host();
  if (name.empty()) return {};
  const std::string port_text = ":" + std::to_string(port());
  return family() == Family::v6 ? "[" + name + "]" + port_text : name + port_text;
}

Address address_of(const IpAddress& ip, std::uint16_t port) {
  Address address = any_address(ip.is_v6 ? Family::v6 : Family::v4, port);
  if (ip.is_v6) {
    std::memcpy(&as<sockaddr_in6>(address).sin6_addr, ip.bytes.data(), sizeof(in6_addr));
    as<sockaddr_in6>(address).sin6_scope_id = ip.scope;
  } else {
    std::memcpy(&as<sockaddr_in>(address).sin_addr, ip.bytes.data(), sizeof(in_addr));
  }
  return address;
}

Address any_address(Family family, std::uint16_t port) {
  Address address;
  if (family == Family::v6) {
    as<sockaddr>(address).sa_family = AF_INET6;
    address.size = sizeof(sockaddr_in6);
  } else {
    as<sockaddr>(address).sa_family = AF_INET;
    address.size = sizeof(sockaddr_in);
  }
  address.set_port(port);
  return address;
}

std::size_t longest_local_path() { return sizeof(sockaddr_un::sun_path) - 1; }

std::optional<Address> local_socket_address(const std::string& path) {
  if (path.size() > longest_local_path()) return std::nullopt;
  Address address;
  auto& local = as<sockaddr_un>(address);
  local.sun_family = AF_UNIX;
  std::memcpy(local.sun_path, path.c_str(), path.size() + 1);
  address.size = static_cast<std::uint32_t>(offsetof(sockaddr_un, sun_path) + path.size() + 1);
  return address;
}

std::vector<Address> look_up(const std::string& host, LookUp how) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = flags_of(how);
  const bool is_named = how != LookUp::own && how != LookUp::everywhere;
  addrinfo* found = nullptr;
  if (getaddrinfo(is_named ? host.c_str() : nullptr, "0", &hints, &found) != 0) return {};
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, &freeaddrinfo);
  std::vector<Address> addresses;
  for (const addrinfo* item = found; item != nullptr; item = item->ai_next) {
    if (item->ai_family != AF_INET && item->ai_family != AF_INET6) continue;
    addresses.push_back(address_of(*item->ai_addr, item->ai_addrlen));
  }
  return addresses;
}

}  // namespace rr::platform
