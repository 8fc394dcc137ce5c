// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>

#include "rr/reader.hpp"
#include "runtime/cpp/src/channel/account.hpp"

namespace rr::service {

class ServerEndpoint;
struct Question;

/// Memory of the texts, lists, maps and structs that one request brings: drawn from the account of
/// its connection while the request is handled, which is while this exists. A small request draws
/// nothing. One that has many of them takes long to read and to free: another thread polls
/// meanwhile.
///
/// As many bytes as the request has itself may be drawn beyond the share of the connection, and a
/// large text waits for its room: whoever may send a message may have it read.
class DecodedMemory final : public ContainerBudget {
 public:
  explicit DecodedMemory(ServerEndpoint& endpoint) : endpoint_(endpoint) {}
  DecodedMemory(ServerEndpoint& endpoint, const Question& question);
  ~DecodedMemory() = default;
  DecodedMemory(const DecodedMemory&) = delete;
  DecodedMemory& operator=(const DecodedMemory&) = delete;

  [[nodiscard]] bool draw(std::size_t bytes) override;
  /// What was drawn, for the answer, which is made when all has been read.
  channel::Charge end() { return std::move(room_); }

 private:
  static constexpr std::size_t free_bytes = 4 * 1024;
  static constexpr std::size_t quantum = 16 * 1024;
  static constexpr std::size_t many_bytes = 128 * 1024;
  static constexpr std::size_t large_text = 256 * 1024;

  [[nodiscard]] bool grow_to(std::size_t wanted, bool may_wait);

  ServerEndpoint& endpoint_;
  const std::size_t request_bytes_ = 0;
  const bool may_wait_ = false;
  std::size_t bytes_ = 0;
  channel::Charge room_;  // has no account until something is drawn
  bool has_given_way_ = false;
};

}  // namespace rr::service
