// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "runtime/cpp/src/serial/port.hpp"

namespace rr::serial {

/// Whether a place is one over TCP: begins with `tcp://`.
bool is_tcp_place(std::string_view path);

/// A connection to a board that listens: the frames of the serial line over TCP.
class TcpPort final : public Port {
 public:
  /// `tcp://host:port`, `tcp://[::1]:4000`. Throws rr::Error (invalid_argument).
  explicit TcpPort(const std::string& path);

  [[nodiscard]] LinkTiming timing() const override { return LinkTiming::of_tcp(); }
  [[nodiscard]] bool is_renewed() const override { return true; }

 protected:
  /// The system looks the name up, which cannot be ended.
  std::string open_file(const std::function<bool()>& is_over) override;
  std::ptrdiff_t put(std::span<const std::uint8_t> bytes) override;

 private:
  std::string host_;
  std::string port_;
};

}  // namespace rr::serial
