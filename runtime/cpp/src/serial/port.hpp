// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/cpp/src/serial/host_link.hpp"

namespace rr::serial {

/// What leads to a board: a serial port, or a connection over TCP. To be used by one thread; wake()
/// by any.
class Port {
 public:
  /// The one to this place: `tcp://host:port`, or else the path of a serial port. Throws rr::Error
  /// (invalid_argument) for a place or rate that there cannot be.
  static std::unique_ptr<Port> to(const std::string& path, std::uint32_t baud);
  virtual ~Port();
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] bool is_open() const { return file_ >= 0; }
  /// Opens it for this process alone. Empty when it is open, else why it is not: `does not exist`.
  /// `is_over` says whether to give up.
  std::string open(const std::function<bool()>& is_over);
  virtual void close();
  /// Waits for bytes, until `limit` or wake(). Nothing when the port is gone, which closes it.
  std::optional<std::vector<std::uint8_t>> read(std::chrono::microseconds limit);
  /// False when the port is gone, which closes it.
  bool write(std::span<const std::uint8_t> bytes);
  /// Ends a read() or open() that waits, or the next one.
  void wake() const;

  /// How quick the line is.
  [[nodiscard]] virtual LinkTiming timing() const = 0;
  /// Whether a board that does not answer is better looked for on a new connection.
  [[nodiscard]] virtual bool is_renewed() const { return false; }

 protected:
  explicit Port(std::string path);
  /// Sets the file. Empty when it is open.
  virtual std::string open_file(const std::function<bool()>& is_over) = 0;
  /// As write() of the system.
  virtual std::ptrdiff_t put(std::span<const std::uint8_t> bytes) = 0;

  int file_ = -1;
  int wake_ = -1;

 private:
  const std::string path_;
};

}  // namespace rr::serial
