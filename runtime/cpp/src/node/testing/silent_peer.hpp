// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <string>

namespace rr::testing {

/// A port whose connections are accepted by the system and answered by nobody, as those of a
/// process that has been stopped.
class SilentPeer {
 public:
  SilentPeer() : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    static_cast<void>(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), size));
    ::listen(socket_, 16);
    ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
  }
  ~SilentPeer() { ::close(socket_); }
  SilentPeer(const SilentPeer&) = delete;
  SilentPeer& operator=(const SilentPeer&) = delete;

  [[nodiscard]] std::string url() const {
    return "rr+tcp://127.0.0.1:" + std::to_string(port_) + "/?service=counter";
  }
  [[nodiscard]] std::uint16_t port() const { return port_; }
  /// Waits for somebody to connect; the connection is closed by the caller.
  [[nodiscard]] int accept() const { return ::accept(socket_, nullptr, nullptr); }

 private:
  int socket_ = -1;
  std::uint16_t port_ = 0;
};

}  // namespace rr::testing
