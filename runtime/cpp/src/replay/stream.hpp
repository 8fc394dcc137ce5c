// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "runtime/cpp/src/channel/layer.hpp"
#include "runtime/cpp/src/channel/shared_carrier.hpp"
#include "runtime/cpp/src/platform/sockets.hpp"

/// Sockets that carry messages, and what may lie around these; nothing here knows what they say.
namespace rr::replay {

using Bytes = std::vector<std::byte>;
using Milliseconds = std::chrono::milliseconds;

/// A socket, closed at the end.
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
  /// The same for a local socket.
  static Stream connect(const std::filesystem::path& local);

  /// From now on `layer` lies around what is sent and received, inside of those before. Begins, and
  /// waits until both sides have agreed; throws std::runtime_error when they do not.
  void put(std::unique_ptr<channel::Layer> layer, Milliseconds limit);

  /// Bytes go through the carrier from now on, whose bell is the socket.
  void share(std::unique_ptr<channel::SharedCarrier> carrier) { shared_ = std::move(carrier); }
  /// Called with each message that has come: true when it has done what is to be done, so that
  /// nobody else gets the message. It may send and receive.
  void set_filter(std::function<bool(Stream&, const Bytes&)> filter) {
    filter_ = std::move(filter);
  }
  /// Messages that have come already, as receive() has them: it has them again, before all others.
  void put_back(const std::vector<Bytes>& messages);
  /// What has come with bytes since the last call, as platform::receive_with_handle() has it.
  platform::Descriptor take_handle() { return std::move(handle_); }

  /// Does nothing on a closed connection: what the peer did is found by receive().
  void send(std::span<const std::byte> bytes);
  /// Waits for a whole message. Bytes that belong to none are skipped until the connection ends.
  Arrival receive(Bytes& message, Milliseconds limit);
  void close() { socket_.close(); }
  [[nodiscard]] bool is_open() const { return socket_.is_open(); }
  [[nodiscard]] int descriptor() const { return socket_.get(); }

 private:
  bool take_message(Bytes& message);
  // Through the layers, the first `count` of them.
  void send_through(std::size_t count, Bytes bytes);
  void write(std::span<const std::byte> bytes);
  // What the system has, or what is there already, through the layers from this one on.
  bool read();
  void take(Bytes bytes, std::size_t first_layer);
  Arrival receive_unfiltered(Bytes& message, Milliseconds limit);
  bool wait_for_bytes(Milliseconds limit);
  std::ptrdiff_t receive_some(std::span<std::byte> room);

  Descriptor socket_;
  std::unique_ptr<channel::SharedCarrier> shared_;
  platform::Descriptor handle_;
  std::function<bool(Stream&, const Bytes&)> filter_;
  std::vector<std::unique_ptr<channel::Layer>> layers_;
  std::string failure_;     // of a layer
  bool has_ended_ = false;  // as a layer says
  Bytes received_;
};

/// Accepts connections on a port of the loopback interface; 0 is any free one.
class Listener {
 public:
  explicit Listener(int port, bool any_interface = false);
  /// At a local socket, which is made there.
  explicit Listener(const std::filesystem::path& local);
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
