// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "runtime/cpp/src/platform/clock.hpp"

/// Serial ports of this machine.
namespace rr::platform {

/// What a port is called in messages: a path on Linux, `COM3` on Windows, which `/COM3` (of a URL),
/// `com3` and `\\.\COM3` are, too. Nothing for what cannot be the name of a port.
std::optional<std::string> serial_port_name(const std::string& path);
/// A name as an example for messages.
const char* serial_port_example();

/// One port, open or not. To be used by one thread; wake() by any.
class SerialPort {
 public:
  /// Throws rr::Error (system_resource_error).
  SerialPort();
  ~SerialPort();
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;

  [[nodiscard]] bool is_open() const;
  /// Opens it for this process alone: 8 bits, no parity, one stop bit, no flow control. `baud` is
  /// one of serial_rates. Empty when it is open, else why it is not: `does not exist`.
  std::string open(const std::string& name, std::uint32_t baud);
  void close();
  /// Waits for bytes until the deadline or wake(). Their number, `nothing_now` or `broken`.
  std::ptrdiff_t receive(std::span<std::byte> room, Time deadline);
  /// False when the port is gone. What a port does not take for a second is lost.
  bool send(std::span<const std::byte> bytes);
  /// Ends a receive() that waits, or the next one.
  void wake() const;

 private:
  struct System;
  const std::unique_ptr<System> system_;
};

/// Bits a second.
inline constexpr std::uint32_t serial_rates[] = {9600,   19200,  38400,  57600,  115200,
                                                 230400, 460800, 500000, 921600, 1000000};

}  // namespace rr::platform
