// SPDX-License-Identifier: Apache-2.0
#include "rr/realtime/udp_socket.hpp"

#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

#include "rr/error.hpp"

namespace rr::realtime {
namespace {

[[noreturn]] void throw_system(const std::string& what) {
  throw Error(ErrorCode::system_resource_error, what + ": " + std::strerror(errno));
}

using Addresses = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

Addresses look_up(const std::string& host, std::uint16_t port, int family, int flags) {
  addrinfo hints{};
  hints.ai_family = family;
  hints.ai_socktype = SOCK_DGRAM;
  hints.ai_flags = flags | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const int result = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found);
  if (result != 0) {
    throw Error(ErrorCode::invalid_argument, "UDP address " + host + ": " + gai_strerror(result));
  }
  return {found, &freeaddrinfo};
}

sockaddr_storage own_address(int file) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  if (getsockname(file, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    throw_system("UDP port");
  }
  return address;
}

}  // namespace

UdpSocket::UdpSocket(const std::string& address, std::uint16_t port) {
  const Addresses found = look_up(address, port, AF_UNSPEC, AI_NUMERICHOST | AI_PASSIVE);
  file_ = socket(found->ai_family, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (file_ < 0) throw_system("UDP socket");
  if (bind(file_, found->ai_addr, found->ai_addrlen) != 0) {
    const int error = errno;
    close(std::exchange(file_, -1));
    errno = error;
    throw_system("UDP port " + std::to_string(port) + " at " + address);
  }
}

UdpSocket::~UdpSocket() {
  if (file_ >= 0) close(file_);
}

UdpSocket::UdpSocket(UdpSocket&& other) noexcept : file_(std::exchange(other.file_, -1)) {}

UdpSocket& UdpSocket::operator=(UdpSocket&& other) noexcept {
  std::swap(file_, other.file_);
  return *this;
}

std::uint16_t UdpSocket::port() const {
  const sockaddr_storage address = own_address(file_);
  return ntohs(address.ss_family == AF_INET6
                   ? reinterpret_cast<const sockaddr_in6&>(address).sin6_port
                   : reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

void UdpSocket::connect(const std::string& host, std::uint16_t port) {
  const Addresses found = look_up(host, port, own_address(file_).ss_family, 0);
  if (::connect(file_, found->ai_addr, found->ai_addrlen) != 0) {
    throw_system("UDP peer " + host + " port " + std::to_string(port));
  }
}

bool UdpSocket::send(std::span<const std::byte> bytes) const {
  return ::send(file_, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL) ==
         static_cast<ssize_t>(bytes.size());
}

std::optional<std::size_t> UdpSocket::receive(std::span<std::byte> bytes) const {
  // An error that belongs to an earlier packet, "nobody listens there", is no packet.
  const ssize_t size = recv(file_, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_TRUNC);
  if (size < 0) return std::nullopt;
  return static_cast<std::size_t>(size);
}

}  // namespace rr::realtime
