// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/serial/port.hpp"

#include "runtime/cpp/src/platform/sockets.hpp"
#include "runtime/cpp/src/serial/serial_port.hpp"
#include "runtime/cpp/src/serial/tcp_port.hpp"

namespace rr::serial {

std::unique_ptr<Port> Port::to(const std::string& path, std::uint32_t baud) {
  if (is_tcp_place(path)) return std::make_unique<TcpPort>(path);
  return std::make_unique<SerialPort>(path, baud);
}

std::optional<std::vector<std::uint8_t>> Port::read(std::chrono::microseconds limit) {
  std::vector<std::uint8_t> bytes(512);
  const std::ptrdiff_t got =
      receive(std::as_writable_bytes(std::span(bytes)), std::chrono::steady_clock::now() + limit);
  if (got == platform::broken) {
    close();
    return std::nullopt;
  }
  bytes.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  return bytes;
}

bool Port::write(std::span<const std::uint8_t> bytes) {
  const bool is_there = send(std::as_bytes(bytes));
  if (!is_there) close();
  return is_there;
}

}  // namespace rr::serial
