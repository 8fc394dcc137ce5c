// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace rr::serial {

/// A serial port, or whatever looks like one. To be used by one thread; wake() by any.
class Port {
 public:
  Port(std::string path, std::uint32_t baud);
  ~Port();
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;

  /// Throws rr::Error (invalid_argument) for a rate that a port cannot have.
  static void check_rate(std::uint32_t baud);

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] bool is_open() const { return port_ >= 0; }
  /// Opens it for this process alone. Empty when it is open, else why it is not: `does not exist`.
  std::string open();
  void close();
  /// Waits for bytes, until `limit` or wake(). Nothing when the port is gone, which closes it.
  std::optional<std::vector<std::uint8_t>> read(std::chrono::microseconds limit);
  /// False when the port is gone, which closes it.
  bool write(std::span<const std::uint8_t> bytes);
  /// Ends a read() that waits, or the next one.
  void wake() const;

 private:
  const std::string path_;
  const std::uint32_t baud_;
  int port_ = -1;
  int wake_ = -1;
};

}  // namespace rr::serial
