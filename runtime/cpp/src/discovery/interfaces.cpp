// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/discovery/interfaces.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <array>
#include <cstring>
#include <memory>

namespace rr::discovery {
namespace {

const in6_addr& v6_of(const channel::Address& address) {
  return reinterpret_cast<const sockaddr_in6&>(address.storage).sin6_addr;
}
const in_addr& v4_of(const channel::Address& address) {
  return reinterpret_cast<const sockaddr_in&>(address.storage).sin_addr;
}

}  // namespace

bool LocalAddress::is_loopback() const {
  if (is_v6()) return IN6_IS_ADDR_LOOPBACK(&v6_of(address)) != 0;
  return ntohl(v4_of(address).s_addr) >> 24 == 127;
}

bool LocalAddress::is_link_local() const {
  return is_v6() && IN6_IS_ADDR_LINKLOCAL(&v6_of(address)) != 0;
}

std::string LocalAddress::host() const {
  std::array<char, INET6_ADDRSTRLEN> text{};
  const void* const bytes = is_v6() ? static_cast<const void*>(&v6_of(address)) : &v4_of(address);
  inet_ntop(address.family(), bytes, text.data(), static_cast<socklen_t>(text.size()));
  return is_v6() ? "[" + std::string(text.data()) + "]" : std::string(text.data());
}

std::vector<LocalAddress> local_addresses() {
  ifaddrs* found = nullptr;
  if (getifaddrs(&found) != 0) return {};
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> owner(found, &freeifaddrs);
  std::vector<LocalAddress> addresses;
  for (const ifaddrs* item = found; item != nullptr; item = item->ifa_next) {
    if (item->ifa_addr == nullptr || (item->ifa_flags & IFF_UP) == 0) continue;
    const int family = item->ifa_addr->sa_family;
    if (family != AF_INET && family != AF_INET6) continue;
    LocalAddress& local = addresses.emplace_back();
    local.address.size = family == AF_INET ? sizeof(sockaddr_in) : sizeof(sockaddr_in6);
    std::memcpy(&local.address.storage, item->ifa_addr, local.address.size);
    local.address.set_port(0);
    local.interface = item->ifa_name;
    local.interface_number = if_nametoindex(item->ifa_name);
  }
  return addresses;
}

std::vector<std::string> reachable_urls(const std::string& base,
                                        const std::vector<LocalAddress>& addresses) {
  const bool is_any_v4 = base.find("://0.0.0.0:") != std::string::npos;
  const bool is_any_v6 = base.find("://[::]:") != std::string::npos;
  if (!is_any_v4 && !is_any_v6) {
    const std::size_t scope = base.find('%');
    if (scope == std::string::npos) return {base};
    return {base.substr(0, scope) + base.substr(base.find(']', scope))};
  }
  std::vector<std::string> urls;
  for (const LocalAddress& address : addresses) {
    if (address.is_v6() != is_any_v6) continue;
    urls.push_back(base.substr(0, base.find("://") + 3) + address.host() +
                   base.substr(base.rfind(':')));
  }
  return urls;
}

}  // namespace rr::discovery
