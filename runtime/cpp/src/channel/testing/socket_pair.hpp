// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

#include "rr/reader.hpp"

namespace rr::testing {

/// Two connected sockets: one that a test writes to and reads from as it likes, and one to be given
/// away.
class SocketPair {
 public:
  SocketPair() {
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends_.data()) != 0) {
      throw std::system_error(errno, std::generic_category(), "socketpair");
    }
  }
  /// The same over TCP on the loopback interface, where the test's end has this address: any of
  /// 127.0.0.0/8.
  explicit SocketPair(const char* from) {
    const auto at = [](const char* host) {
      sockaddr_in address{};
      address.sin_family = AF_INET;
      inet_pton(AF_INET, host, &address.sin_addr);
      return address;
    };
    sockaddr_in here = at("127.0.0.1");
    const sockaddr_in there = at(from);
    socklen_t size = sizeof here;
    const int listener = ::socket(AF_INET, SOCK_STREAM, 0);
    ends_[0] = ::socket(AF_INET, SOCK_STREAM, 0);
    const bool is_connected =
        ::bind(listener, reinterpret_cast<const sockaddr*>(&here), size) == 0 &&
        ::listen(listener, 1) == 0 &&
        ::getsockname(listener, reinterpret_cast<sockaddr*>(&here), &size) == 0 &&
        ::bind(ends_[0], reinterpret_cast<const sockaddr*>(&there), sizeof there) == 0 &&
        ::connect(ends_[0], reinterpret_cast<const sockaddr*>(&here), size) == 0;
    const int error = errno;
    if (is_connected) ends_[1] = ::accept(listener, nullptr, nullptr);
    ::close(listener);
    if (!is_connected) throw std::system_error(error, std::generic_category(), "connect");
  }
  ~SocketPair() {
    for (const int end : ends_) {
      if (end >= 0) ::close(end);
    }
  }
  SocketPair(const SocketPair&) = delete;
  SocketPair& operator=(const SocketPair&) = delete;

  [[nodiscard]] int other() const { return ends_[1]; }
  /// The test's end.
  [[nodiscard]] int own() const { return ends_[0]; }
  /// Whether there is room to send in time.
  [[nodiscard]] bool may_send(int milliseconds) const {
    pollfd writable{.fd = ends_[0], .events = POLLOUT, .revents = 0};
    return poll(&writable, 1, milliseconds) == 1 && (writable.revents & POLLOUT) != 0;
  }
  /// The caller closes it from now on.
  int give_away() { return std::exchange(ends_[1], -1); }

  void send(std::span<const std::byte> bytes) const {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(ends_[0], bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) throw std::system_error(errno, std::generic_category(), "send");
      bytes = bytes.subspan(static_cast<std::size_t>(sent));
    }
  }
  /// What is there, or comes in time, up to `size` bytes.
  [[nodiscard]] std::vector<std::byte> receive(std::size_t size, int milliseconds) const {
    std::vector<std::byte> bytes(size);
    std::size_t have = 0;
    while (have != size) {
      pollfd readable{.fd = ends_[0], .events = POLLIN, .revents = 0};
      if (poll(&readable, 1, milliseconds) != 1) break;
      const ssize_t got = recv(ends_[0], bytes.data() + have, size - have, 0);
      if (got <= 0) break;
      have += static_cast<std::size_t>(got);
    }
    bytes.resize(have);
    return bytes;
  }
  /// The next message; empty when none comes in time.
  [[nodiscard]] std::vector<std::byte> receive_message(int milliseconds) const {
    constexpr std::size_t head = 10;
    std::vector<std::byte> bytes = receive(head, milliseconds);
    if (bytes.size() != head) return {};
    const std::vector<std::byte> rest = receive(message_size(bytes, {}) - head, milliseconds);
    bytes.insert(bytes.end(), rest.begin(), rest.end());
    return bytes;
  }

 private:
  std::array<int, 2> ends_{-1, -1};
};

}  // namespace rr::testing
