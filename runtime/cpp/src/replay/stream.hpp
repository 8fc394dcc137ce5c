// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

/// Plain TCP that carries messages; nothing here knows what they say.
namespace rr::replay {

using Bytes = std::vector<std::byte>;
using Milliseconds = std::chrono::milliseconds;

/// An open file descriptor, closed at the end.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor() { close(); }

  [[nodiscard]] int get() const { return number_; }
  [[nodiscard]] bool is_open() const { return number_ >= 0; }
  void close();

 private:
  int number_ = -1;
};

enum class Arrival { message, closed, nothing };

/// One connection.
class Stream {
 public:
  Stream() = default;
  explicit Stream(Descriptor socket);

  /// Throws std::runtime_error when nobody answers there.
  static Stream connect(const std::string& host, int port);

  /// Does nothing on a closed connection: what the peer did is found by receive().
  void send(std::span<const std::byte> bytes);
  /// Waits for a whole message. Bytes that belong to none are skipped until the connection ends.
  Arrival receive(Bytes& message, Milliseconds limit);
  void close() { socket_.close(); }
  [[nodiscard]] bool is_open() const { return socket_.is_open(); }
  [[nodiscard]] int descriptor() const { return socket_.get(); }

 private:
  bool take_message(Bytes& message);

  Descriptor socket_;
  Bytes received_;
};

/// Accepts connections on a port of the loopback interface; 0 is any free one.
class Listener {
 public:
  explicit Listener(int port, bool any_interface = false);
  [[nodiscard]] int port() const { return port_; }
  [[nodiscard]] int descriptor() const { return socket_.get(); }
  std::optional<Stream> accept(Milliseconds limit);

 private:
  Descriptor socket_;
  int port_ = 0;
};

/// True when `descriptor` can be read within the limit.
bool wait_readable(int descriptor, Milliseconds limit);

}  // namespace rr::replay
