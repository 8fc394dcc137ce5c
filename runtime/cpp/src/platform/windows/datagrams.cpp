// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/datagrams.hpp"

#include <cstring>

#include "errors.hpp"
#include "opened_socket.hpp"
#include "system_sockets.hpp"

namespace rr::platform {
namespace {

SOCKET system(int socket) { return static_cast<SOCKET>(socket); }
const sockaddr* system(const Address& address) {
  return reinterpret_cast<const sockaddr*>(address.bytes.data());
}

template <class Value>
void set(int socket, int level, int name, Value value) {
  setsockopt(system(socket), level, name, reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

Descriptor open_datagrams(const Address& at, std::optional<unsigned> interface_number,
                          std::error_code& error) {
  const int family = system(at)->sa_family;
  Descriptor socket = open_socket(family, SOCK_DGRAM);
  if (socket) {
    set(socket.get(), SOL_SOCKET, SO_REUSEADDR, BOOL{TRUE});
    if (family == AF_INET6) {
      set(socket.get(), IPPROTO_IPV6, IPV6_V6ONLY, DWORD{1});
    } else {
      set(socket.get(), SOL_SOCKET, SO_BROADCAST, BOOL{TRUE});
    }
    if (family == AF_INET6 && interface_number) {
      set(socket.get(), IPPROTO_IPV6, IPV6_MULTICAST_IF, DWORD{*interface_number});
      set(socket.get(), IPPROTO_IPV6, IPV6_MULTICAST_LOOP, DWORD{1});
    }
    if (::bind(system(socket.get()), system(at), static_cast<int>(at.size)) == 0) return socket;
  }
  error = last_socket_error();
  return {};
}

void join_group(int socket, const IpAddress& group, unsigned interface_number) {
  ipv6_mreq wanted{};
  std::memcpy(&wanted.ipv6mr_multiaddr, group.bytes.data(), sizeof wanted.ipv6mr_multiaddr);
  wanted.ipv6mr_interface = interface_number;
  set(socket, IPPROTO_IPV6, IPV6_ADD_MEMBERSHIP, wanted);
}

void send_datagram(int socket, std::string_view content, const Address& to) {
  ::sendto(system(socket), content.data(), static_cast<int>(content.size()), 0, system(to),
           static_cast<int>(to.size));
}

std::ptrdiff_t receive_datagram(int socket, std::span<char> room, Address& sender) {
  int size = sizeof sender.bytes;
  int received = ::recvfrom(system(socket), room.data(), static_cast<int>(room.size()), 0,
                            reinterpret_cast<sockaddr*>(sender.bytes.data()), &size);
  // One that was cut counts as an error here.
  if (received < 0 && WSAGetLastError() == WSAEMSGSIZE) received = static_cast<int>(room.size());
  sender.size = received < 0 ? 0 : static_cast<std::uint32_t>(size);
  if (received >= 0) return received;
  return WSAGetLastError() == WSAEWOULDBLOCK ? nothing_now : broken;
}

bool has_datagram(int socket) {
  WSAPOLLFD asked{system(socket), POLLRDNORM, 0};
  return WSAPoll(&asked, 1, 0) > 0;
}

}  // namespace rr::platform
