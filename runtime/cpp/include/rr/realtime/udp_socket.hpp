// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "rr/visibility.hpp"

namespace RR_VISIBLE rr {
namespace realtime {

/// A UDP socket that never waits. Opened while a program is set up, then used by one thread.
class UdpSocket {
 public:
  /// Listens at an address of this machine (`127.0.0.1`, `::`) and a port, 0 for any free one.
  /// Throws rr::Error (invalid_argument for what is no address, system_resource_error).
  UdpSocket(const std::string& address, std::uint16_t port);
  ~UdpSocket();
  /// Takes over the socket.
  UdpSocket(UdpSocket&& other) noexcept;
  /// Closes this socket, and takes over the other one.
  UdpSocket& operator=(UdpSocket&& other) noexcept;

  /// The port at which it listens.
  [[nodiscard]] std::uint16_t port() const;
  /// From now on sends to this peer and hears no other. A name is looked up, which may take its
  /// time. Throws rr::Error.
  void connect(const std::string& host, std::uint16_t port);
  /// One call of the kernel. False when the packet was not taken: no room, no peer, no socket
  /// there. It is not repeated; the next one says more.
  bool send(std::span<const std::byte> bytes) const;
  /// One call of the kernel: the size of the packet that waits longest; nothing when none does.
  /// What does not fit into `bytes` gives a size larger than it.
  std::optional<std::size_t> receive(std::span<std::byte> bytes) const;

 private:
  int file_ = -1;
};

}  // namespace realtime
}  // namespace rr
