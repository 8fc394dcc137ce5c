// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "runtime/cpp/src/channel/account.hpp"
#include "runtime/cpp/src/codec/large_allocations.hpp"

namespace rr::service {

class ServerEndpoint;
struct Question;

/// What the handler of a request makes before it answers, drawn from the account of the connection
/// (docs/reference/limits.md): the bytes that are expected of it before it runs, and large arrays
/// that it makes beyond them when it makes them. A quarter of the pool at most: one that makes more
/// is not refused for it. With the dispatch turn.
class HandlerMemory final : private codec::LargeAllocations {
 public:
  /// Draws nothing yet, but for arrays that are made meanwhile.
  HandlerMemory(ServerEndpoint& endpoint, const Question& question, std::size_t expected);
  ~HandlerMemory() = default;
  HandlerMemory(const HandlerMemory&) = delete;
  HandlerMemory& operator=(const HandlerMemory&) = delete;

  /// Draws what is expected: when the request has been read, since whoever waits for that must find
  /// room (channel::Pool). Waits until there is some (Budget::patience), but not with requests that
  /// came with others: their answers gather. Throws rr::Error (out_of_system_resource), as does
  /// what allocates.
  void expect();
  /// What follows is not the handler's: what it has made is drawn anew where it waits to be sent.
  /// Returns what was drawn for it.
  channel::Charge end();

 private:
  void before(std::size_t bytes) override;
  void freed(std::size_t bytes) noexcept override;
  void grow_to(std::size_t bytes);

  ServerEndpoint& endpoint_;
  const std::size_t expected_;
  const bool may_wait_;
  channel::Charge room_;  // has no account until something is drawn: most handlers make little
  std::size_t used_ = 0;  // by arrays
  std::optional<codec::WatchedThread> watched_;
};

}  // namespace rr::service
