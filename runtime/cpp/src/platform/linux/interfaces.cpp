// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/interfaces.hpp"

#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <cstring>
#include <memory>

namespace rr::platform {

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
    std::memcpy(local.address.bytes.data(), item->ifa_addr, local.address.size);
    local.address.set_port(0);
    local.interface = item->ifa_name;
    local.interface_number = if_nametoindex(item->ifa_name);
  }
  return addresses;
}

}  // namespace rr::platform
