// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

#include "rr/wire.hpp"

namespace rr::service {

class ServerEndpoint;

/// Answers to the requests of one message, which leave in one message too, when the last is there;
/// in several if one cannot hold them.
class Gathering {
 public:
  Gathering(std::weak_ptr<ServerEndpoint> endpoint, MessageVersion version, std::size_t count)
      : endpoint_(std::move(endpoint)), version_(version), entries_(count), missing_(count) {}

  [[nodiscard]] MessageVersion version() const { return version_; }
  /// A whole entry; empty for what is not answered. `is_late` when it comes after the message has
  /// been handled.
  void put(std::size_t place, std::vector<std::byte> entry, bool is_late = false);

 private:
  void send(ServerEndpoint& endpoint, std::size_t first, std::size_t end, bool is_late);

  const std::weak_ptr<ServerEndpoint> endpoint_;  // not kept by answers that are owed
  const MessageVersion version_;
  std::mutex mutex_;
  std::vector<std::vector<std::byte>> entries_;
  std::size_t missing_;
};

}  // namespace rr::service
