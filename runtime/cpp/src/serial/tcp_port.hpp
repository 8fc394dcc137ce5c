// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>

#include "runtime/cpp/src/platform/sockets.hpp"
#include "runtime/cpp/src/serial/port.hpp"

namespace rr::serial {

/// Whether a place is one over TCP: begins with `tcp://`.
bool is_tcp_place(std::string_view path);

/// A connection to a board that listens: the frames of the serial line over TCP.
class TcpPort final : public Port {
 public:
  /// `tcp://host:port`, `tcp://[::1]:4000`. Throws rr::Error (invalid_argument).
  explicit TcpPort(const std::string& path);

  [[nodiscard]] bool is_open() const override { return static_cast<bool>(socket_); }
  /// The system looks the name up, which cannot be ended.
  std::string open(const std::function<bool()>& is_over) override;
  void close() override { socket_ = {}; }
  void wake() const override;
  [[nodiscard]] LinkTiming timing() const override { return LinkTiming::of_tcp(); }
  [[nodiscard]] bool is_renewed() const override { return true; }

 protected:
  std::ptrdiff_t receive(std::span<std::byte> room, platform::Time deadline) override;
  bool send(std::span<const std::byte> bytes) override;

 private:
  bool wait(std::uint32_t events, platform::Time deadline);
  std::error_code finish_connecting(platform::Time deadline, const std::function<bool()>& is_over);

  std::string host_;
  std::uint16_t number_ = 0;
  platform::Descriptor socket_;
  // A byte from one to the other ends a wait.
  platform::Descriptor ringing_;
  platform::Descriptor ringer_;
};

}  // namespace rr::serial
