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
#include <utility>
#include <vector>

#include "runtime/cpp/src/platform/clock.hpp"
#include "runtime/cpp/src/serial/host_link.hpp"

namespace rr::serial {

/// What leads to a board: a serial port, or a connection over TCP. To be used by one thread; wake()
/// by any.
class Port {
 public:
  /// The one to this place: `tcp://host:port`, or else the path of a serial port. Throws rr::Error
  /// (invalid_argument) for a place or rate that there cannot be.
  static std::unique_ptr<Port> to(const std::string& path, std::uint32_t baud);
  virtual ~Port() = default;
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;

  /// As messages name it.
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] virtual bool is_open() const = 0;
  /// Opens it for this process alone. Empty when it is open, else why it is not: `does not exist`.
  /// `is_over` says whether to give up.
  virtual std::string open(const std::function<bool()>& is_over) = 0;
  virtual void close() = 0;
  /// Waits for bytes, until `limit` or wake(). Nothing when the port is gone, which closes it.
  std::optional<std::vector<std::uint8_t>> read(std::chrono::microseconds limit);
  /// False when the port is gone, which closes it. What a port does not take for a second is lost,
  /// and sent again like everything that is.
  bool write(std::span<const std::uint8_t> bytes);
  /// Ends a read() or open() that waits, or the next one.
  virtual void wake() const = 0;

  /// How quick the line is.
  [[nodiscard]] virtual LinkTiming timing() const = 0;
  /// Whether a board that does not answer is better looked for on a new connection.
  [[nodiscard]] virtual bool is_renewed() const { return false; }

 protected:
  explicit Port(std::string path) : path_(std::move(path)) {}
  /// The number of bytes, or `nothing_now` or `broken` of the platform.
  virtual std::ptrdiff_t receive(std::span<std::byte> room, platform::Time deadline) = 0;
  /// False when the port is gone.
  virtual bool send(std::span<const std::byte> bytes) = 0;

 private:
  const std::string path_;
};

}  // namespace rr::serial
