// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/datagrams.hpp"

#include <netinet/in.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>

#include "runtime/cpp/src/platform/linux/system_calls.hpp"

namespace rr::platform {
namespace {

template <class Value>
void set(int socket, int level, int name, const Value& value) {
  setsockopt(socket, level, name, &value, sizeof value);
}

}  // namespace

Descriptor open_datagrams(const Address& at, std::optional<unsigned> interface_number,
                          std::error_code& error) {
  const int family = system(at)->sa_family;
  Descriptor socket(::socket(family, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (socket) {
    set(socket.get(), SOL_SOCKET, SO_REUSEADDR, 1);
    if (family == AF_INET6) {
      set(socket.get(), IPPROTO_IPV6, IPV6_V6ONLY, 1);
    } else {
      set(socket.get(), SOL_SOCKET, SO_BROADCAST, 1);
    }
    if (family == AF_INET6 && interface_number) {
      set(socket.get(), IPPROTO_IPV6, IPV6_MULTICAST_IF, *interface_number);
      set(socket.get(), IPPROTO_IPV6, IPV6_MULTICAST_LOOP, 1);
    }
    if (::bind(socket.get(), system(at), at.size) == 0) return socket;
  }
  error = {errno, std::generic_category()};
  return {};
}

void join_group(int socket, const IpAddress& group, unsigned interface_number) {
  ipv6_mreq wanted{};
  std::memcpy(&wanted.ipv6mr_multiaddr, group.bytes.data(), sizeof wanted.ipv6mr_multiaddr);
  wanted.ipv6mr_interface = interface_number;
  set(socket, IPPROTO_IPV6, IPV6_JOIN_GROUP, wanted);
}

void send_datagram(int socket, std::string_view content, const Address& to) {
  ::sendto(socket, content.data(), content.size(), MSG_NOSIGNAL, system(to), to.size);
}

std::ptrdiff_t receive_datagram(int socket, std::span<char> room, Address& sender) {
  socklen_t size = sizeof sender.bytes;
  const ssize_t received = ::recvfrom(socket, room.data(), room.size(), MSG_DONTWAIT,
                                      reinterpret_cast<sockaddr*>(sender.bytes.data()), &size);
  sender.size = received < 0 ? 0 : size;
  if (received >= 0) return received;
  return errno == EAGAIN || errno == EWOULDBLOCK ? nothing_now : broken;
}

bool has_datagram(int socket) {
  char one = 0;
  return ::recv(socket, &one, sizeof one, MSG_DONTWAIT | MSG_PEEK) >= 0;
}

}  // namespace rr::platform
