// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "runtime/cpp/src/platform/serial_port.hpp"
#include "runtime/cpp/src/serial/port.hpp"

namespace rr::serial {

/// A serial port of this machine, or whatever looks like one.
class SerialPort final : public Port {
 public:
  /// Throws rr::Error (invalid_argument) for a path or rate that a port cannot have.
  SerialPort(const std::string& path, std::uint32_t baud);

  /// The path as messages name it. Throws rr::Error (invalid_argument).
  static std::string name_of(const std::string& path);

  [[nodiscard]] bool is_open() const override { return port_.is_open(); }
  std::string open(const std::function<bool()>& is_over) override;
  void close() override { port_.close(); }
  void wake() const override { port_.wake(); }
  [[nodiscard]] LinkTiming timing() const override { return LinkTiming::of_serial(baud_); }

 protected:
  std::ptrdiff_t receive(std::span<std::byte> room, platform::Time deadline) override;
  bool send(std::span<const std::byte> bytes) override { return port_.send(bytes); }

 private:
  const std::uint32_t baud_;
  platform::SerialPort port_;
};

}  // namespace rr::serial
