// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "rr/tap.hpp"
#include "runtime/cpp/src/replay/address.hpp"

namespace rr::replay {

/// The reasons of connections that were closed as they should be.
inline constexpr std::string_view closed_by_client = "the client closed the connection";
inline constexpr std::string_view closed_by_service = "the service closed the connection";

struct ProxyOptions {
  int port = 0;                     ///< to listen at; 0: any
  bool listens_everywhere = false;  ///< at all addresses, not on the loopback interface only
  /// Told in a line what a user should know. Called on any thread.
  std::function<void(const std::string&)> log{};
};

/// Stands between clients and a service: passes on every byte as it came, before the next one is
/// read, and tells a tap of the messages that they make. Knows nothing of either implementation;
/// what is no message of this protocol passes all the same, but is not told.
class Proxy {
 public:
  /// Listens, and begins. Throws rr::Error (connection_error) when it cannot listen there.
  Proxy(std::shared_ptr<Tap> tap, HostPort service, ProxyOptions options = {});
  /// As stop().
  ~Proxy();
  Proxy(const Proxy&) = delete;
  Proxy& operator=(const Proxy&) = delete;

  [[nodiscard]] int port() const;
  /// Ends all connections, and waits for the threads.
  void stop();

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

}  // namespace rr::replay
