// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/cpp/fuzz/recorded_service.hpp"

namespace rr::fuzz {

/// A service that follows an input: what it sends instead of each thing that it should. The input
/// is read byte by byte; after its end the service is honest.
class HostileScript {
 public:
  explicit HostileScript(const RecordedService& recorded) : recorded_(&recorded) {}

  void start(std::span<const std::byte> input);

  /// What is sent for one entry of a client's message, in this order. Nothing: the connection ends.
  using Messages = std::optional<std::vector<Bytes>>;
  Messages answer(const MessageTree& message, const EntryTree& request);

 private:
  [[nodiscard]] std::uint8_t next();
  [[nodiscard]] std::uint32_t next_code();
  [[nodiscard]] MessageTree honest_answer(const EntryTree& request);
  [[nodiscard]] MessageTree forged();
  void change(MessageTree& message, std::size_t codes);
  bool play(const MessageTree& message, std::vector<Bytes>& out);

  const RecordedService* recorded_;
  std::mutex mutex_;
  Bytes input_;
  std::size_t at_ = 0;
  std::size_t passes_ = 0;
  std::size_t sent_ = 0;                      // bytes
  std::map<std::string, std::size_t> asked_;  // how often each request was
  std::vector<MessageTree> before_;
  std::optional<MessageTree> held_;
  MessageTree request_;  // of which the answers have the other side's addresses
};

}  // namespace rr::fuzz
