// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/interfaces.hpp"

#include "system_sockets.hpp"
// After it:
#include <iphlpapi.h>

#include <algorithm>
#include <cstring>

#include "errors.hpp"

#undef interface  // a word of COM

namespace rr::platform {
namespace {

// The table of the system; empty when it does not tell.
std::vector<std::byte> adapter_table() {
  constexpr ULONG flags =
      GAA_FLAG_SKIP_ANYCAST | GAA_FLAG_SKIP_MULTICAST | GAA_FLAG_SKIP_DNS_SERVER;
  constexpr int attempts = 4;  // it may grow between two of them
  ULONG size = 16 * 1024;
  for (int attempt = 0; attempt != attempts; ++attempt) {
    std::vector<std::byte> table(size);
    auto* const first = reinterpret_cast<IP_ADAPTER_ADDRESSES*>(table.data());
    const ULONG result = GetAdaptersAddresses(AF_UNSPEC, flags, nullptr, first, &size);
    if (result == ERROR_SUCCESS) return table;
    if (result != ERROR_BUFFER_OVERFLOW) break;
  }
  return {};
}

}  // namespace

std::vector<LocalAddress> local_addresses() {
  const std::vector<std::byte> table = adapter_table();
  if (table.empty()) return {};
  std::vector<LocalAddress> addresses;
  for (const auto* adapter = reinterpret_cast<const IP_ADAPTER_ADDRESSES*>(table.data());
       adapter != nullptr; adapter = adapter->Next) {
    if (adapter->OperStatus != IfOperStatusUp) continue;
    for (const auto* item = adapter->FirstUnicastAddress; item != nullptr; item = item->Next) {
      const SOCKET_ADDRESS& found = item->Address;
      const int family = found.lpSockaddr->sa_family;
      if (family != AF_INET && family != AF_INET6) continue;
      LocalAddress& local = addresses.emplace_back();
      local.address.size = static_cast<std::uint32_t>(
          std::min(static_cast<std::size_t>(found.iSockaddrLength), local.address.bytes.size()));
      std::memcpy(local.address.bytes.data(), found.lpSockaddr, local.address.size);
      local.address.set_port(0);
      local.interface = narrow(adapter->FriendlyName);
      local.interface_number = family == AF_INET6 ? adapter->Ipv6IfIndex : adapter->IfIndex;
    }
  }
  return addresses;
}

}  // namespace rr::platform
