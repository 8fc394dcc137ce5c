// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "runtime/cpp/src/serial/port.hpp"

namespace rr::serial {

/// A serial port of this machine, or whatever looks like one.
class SerialPort final : public Port {
 public:
  /// Throws rr::Error (invalid_argument) for a rate that a port cannot have.
  SerialPort(const std::string& path, std::uint32_t baud);
  ~SerialPort() override;

  static void check_rate(std::uint32_t baud);

  void close() override;
  [[nodiscard]] LinkTiming timing() const override { return LinkTiming::of_serial(baud_); }

 protected:
  std::string open_file(const std::function<bool()>& is_over) override;
  std::ptrdiff_t put(std::span<const std::uint8_t> bytes) override;

 private:
  const std::uint32_t baud_;
};

}  // namespace rr::serial
