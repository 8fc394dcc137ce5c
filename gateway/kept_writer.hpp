// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/carrier.hpp"
#include "gateway/nats_message.hpp"

namespace rr::gateway {

/// Retained messages on their way to a stream. The newest of each subject is repeated until the
/// stream says that it is stored. No threads, no clock.
class KeptWriter {
 public:
  using Clock = std::chrono::steady_clock;

  /// Confirmations arrive at `inbox.<token>`.
  explicit KeptWriter(std::string inbox) : inbox_(std::move(inbox)) {}

  /// What is to be published for a message; it takes the place of an earlier one. Its subject is
  /// that of the stream.
  NatsMessage add(NatsMessage message, Clock::time_point now);
  /// What became of one.
  struct Outcome {
    bool wants_stream = false;         ///< there is no stream yet
    std::optional<Refusal> refusal{};  ///< the stream does not take it for now
  };
  /// A confirmation has arrived.
  Outcome take(std::string_view token, const NatsMessage& answer);
  /// The broker does not permit messages to this subject: it is not repeated.
  void drop(const std::string& subject);
  /// What has to be published again, since it was published `patience` ago.
  std::vector<NatsMessage> late(Clock::time_point now,
                                std::chrono::milliseconds patience = std::chrono::seconds(2));
  /// Whether all are stored.
  [[nodiscard]] bool is_empty() const { return waiting_.empty(); }

 private:
  struct Waiting {
    NatsMessage message;
    Clock::time_point sent;
  };

  const std::string inbox_;
  std::uint64_t last_token_ = 0;
  std::map<std::string, Waiting> waiting_;                    // by subject
  std::map<std::string, std::string, std::less<>> subjects_;  // by token
};

}  // namespace rr::gateway
