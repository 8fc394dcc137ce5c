// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/discovery/datagram_sender.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <set>

#include "runtime/cpp/src/channel/socket.hpp"
#include "runtime/cpp/src/discovery/datagram_receiver.hpp"

namespace rr::discovery {
namespace {

channel::Descriptor open_at(const LocalAddress& from, std::uint16_t port) {
  channel::Descriptor socket(
      ::socket(from.address.family(), SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!socket) return {};
  const int on = 1;
  setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (from.is_v6()) {
    const unsigned number = from.interface_number;
    setsockopt(socket.get(), IPPROTO_IPV6, IPV6_MULTICAST_IF, &number, sizeof number);
    setsockopt(socket.get(), IPPROTO_IPV6, IPV6_MULTICAST_LOOP, &on, sizeof on);
  } else {
    setsockopt(socket.get(), SOL_SOCKET, SO_BROADCAST, &on, sizeof on);
  }
  channel::Address place = from.address;
  place.set_port(port);
  if (bind(socket.get(), reinterpret_cast<const sockaddr*>(&place.storage), place.size) != 0) {
    return {};
  }
  return socket;
}

std::vector<channel::Address> destinations(const DiscoveryNetwork& network,
                                           const LocalAddress& from) {
  std::vector<channel::Address> result;
  if (!from.is_v6()) {
    channel::Address everybody;
    auto& v4 = reinterpret_cast<sockaddr_in&>(everybody.storage);
    v4.sin_family = AF_INET;
    v4.sin_addr.s_addr = INADDR_BROADCAST;
    everybody.size = sizeof v4;
    result.push_back(everybody);
  } else {
    for (const char* const text : groups_of(network, from.is_loopback())) {
      channel::Address group;
      auto& v6 = reinterpret_cast<sockaddr_in6&>(group.storage);
      v6.sin6_family = AF_INET6;
      inet_pton(AF_INET6, text, &v6.sin6_addr);
      v6.sin6_scope_id = from.interface_number;
      group.size = sizeof v6;
      result.push_back(group);
    }
  }
  for (channel::Address& address : result) address.set_port(network.port);
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
        sendto(socket.get(), packet.data(), packet.size(), MSG_NOSIGNAL,
               reinterpret_cast<const sockaddr*>(&place.storage), place.size);
      }
    }
  }
}

}  // namespace rr::discovery
