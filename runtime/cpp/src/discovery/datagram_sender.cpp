// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/discovery/datagram_sender.hpp"

#include <algorithm>
#include <system_error>

#include "runtime/cpp/src/channel/socket.hpp"
#include "runtime/cpp/src/discovery/datagram_receiver.hpp"
#include "runtime/cpp/src/platform/datagrams.hpp"

namespace rr::discovery {
namespace {

channel::Descriptor open_at(const LocalAddress& from, std::uint16_t port) {
  channel::Address place = from.address;
  place.set_port(port);
  std::error_code unused;
  return platform::open_datagrams(place, from.interface_number, unused);
}

std::vector<channel::Address> destinations(const DiscoveryNetwork& network,
                                           const LocalAddress& from) {
  std::vector<channel::Address> result;
  if (!from.is_v6()) {
    platform::IpAddress everybody;
    std::fill_n(everybody.bytes.begin(), 4, std::uint8_t{255});
    return {platform::address_of(everybody, network.port)};
  }
  for (const char* const text : groups_of(network, from.is_loopback())) {
    auto group = platform::parse_ip(text).value();
    group.scope = from.interface_number;
    result.push_back(platform::address_of(group, network.port));
  }
  return result;
}

bool is_used(const DiscoveryNetwork& network, const LocalAddress& from) {
  const auto& names = network.interfaces;
  if (!names.empty() && std::find(names.begin(), names.end(), from.interface) == names.end()) {
    return false;
  }
  return from.is_v6() ? from.is_link_local() || from.is_loopback() : network.ipv4_broadcast;
}

}  // namespace

void send_from_all(
    const DiscoveryNetwork& network,
    const std::function<std::vector<std::string>(const LocalAddress& from)>& packets_for) {
  for (const LocalAddress& from : local_addresses()) {
    if (!is_used(network, from)) continue;
    const std::vector<channel::Address> places = destinations(network, from);
    const std::vector<std::string> packets = packets_for(from);
    if (places.empty() || packets.empty()) continue;
    const channel::Descriptor socket = open_at(from, network.port);
    if (!socket) continue;
    for (const std::string& packet : packets) {
      for (const channel::Address& place : places) {
        platform::send_datagram(socket.get(), packet, place);
      }
    }
  }
}

}  // namespace rr::discovery
