// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <system_error>

#include "runtime/cpp/src/platform/address.hpp"
#include "runtime/cpp/src/platform/waiting.hpp"

namespace rr::testing {

/// A connection to a port of this machine, for bytes of any kind.
class RawSocket {
 public:
  explicit RawSocket(std::uint16_t port) {
    const platform::IpAddress loopback{.bytes = {127, 0, 0, 1}};
    std::error_code error;
    const auto begun =
        platform::begin_connect(platform::address_of(loopback, port), socket_, error);
    if (begun == platform::Connecting::begun) wait(platform::ready::room);
  }

  void send(std::string_view bytes) const {
    auto left = std::as_bytes(std::span(bytes));
    while (!left.empty() && wait(platform::ready::room)) {
      const std::ptrdiff_t size = platform::send(socket_.get(), left);
      if (size == platform::nothing_now) continue;
      if (size < 0) return;
      left = left.subspan(static_cast<std::size_t>(size));
    }
  }
  /// What comes until a text is there, the connection ends, or for some seconds.
  [[nodiscard]] std::string receive_until(std::string_view end) const {
    std::string text;
    std::array<char, 4096> bytes{};
    while (text.find(end) == std::string::npos && wait(platform::ready::input)) {
      const std::ptrdiff_t size = platform::receive(
          socket_.get(), std::as_writable_bytes(std::span(bytes)), platform::Wait::none);
      if (size == platform::nothing_now) continue;
      if (size <= 0) break;
      text.append(bytes.data(), static_cast<std::size_t>(size));
    }
    return text;
  }
  /// Everything up to the end of the connection.
  [[nodiscard]] std::string receive_all() const { return receive_until("\x01never\x01"); }

 private:
  // For some seconds at most.
  bool wait(std::uint32_t events) const {
    return platform::wait_for(socket_.get(), events,
                              std::chrono::steady_clock::now() + std::chrono::seconds(20));
  }

  platform::Descriptor socket_;
};

}  // namespace rr::testing
