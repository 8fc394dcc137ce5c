// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace rr::testing {

/// A connection to a port of this machine, for bytes of any kind.
class RawSocket {
 public:
  explicit RawSocket(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  }
  RawSocket(RawSocket&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}
  RawSocket& operator=(RawSocket&&) = delete;
  ~RawSocket() {
    if (socket_ >= 0) ::close(socket_);
  }

  void send(std::string_view bytes) const {
    [[maybe_unused]] const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }
  /// What comes until a text is there, the connection ends, or for some seconds.
  [[nodiscard]] std::string receive_until(std::string_view end) const {
    std::string text;
    std::array<char, 4096> bytes{};
    pollfd wanted{socket_, POLLIN, 0};
    while (text.find(end) == std::string::npos && ::poll(&wanted, 1, 20'000) > 0) {
      const ssize_t size = ::recv(socket_, bytes.data(), bytes.size(), 0);
      if (size <= 0) break;
      text.append(bytes.data(), static_cast<std::size_t>(size));
    }
    return text;
  }
  /// Everything up to the end of the connection.
  [[nodiscard]] std::string receive_all() const { return receive_until("\x01never\x01"); }

 private:
  int socket_;
};

}  // namespace rr::testing
