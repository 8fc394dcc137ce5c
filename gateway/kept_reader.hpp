// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/nats_message.hpp"

namespace rr::gateway {

/// A message that a stream had when it was read.
struct KeptMessage {
  NatsMessage message;              ///< with the subject of the stream
  std::uint64_t number = 0;         ///< in the stream
  std::chrono::nanoseconds age{0};  ///< by the broker's clock
};

/// Reads the newest messages of a stream, for several filters at once. No threads, no clock: its
/// owner listens at inboxes and sends requests.
class KeptReader {
 public:
  using Clock = std::chrono::steady_clock;

  /// Answers arrive at `answers.<token>`, messages at `messages.<number>`. `name` is that of
  /// readers at the broker, which must be no other's.
  KeptReader(std::string answers, std::string messages, std::string name)
      : answers_(std::move(answers)), messages_(std::move(messages)), name_(std::move(name)) {}

  /// A filter of subjects of the stream is to be read; its number.
  std::uint64_t add(const std::string& kept_filter);
  /// Where messages of a number arrive; to be listened to before requests are sent.
  [[nodiscard]] std::string inbox_of(std::uint64_t number) const;
  /// What is to be requested now.
  std::vector<NatsMessage> requests(Clock::time_point now);
  /// An answer to a request. False when it has to be made again, or is none.
  bool take_answer(std::string_view token, const NatsMessage& answer, Clock::time_point now);
  /// A message of the stream.
  void take_message(std::string_view number, NatsMessage message, Clock::time_point now);
  /// The broker does not permit a request. False when it is none of these.
  bool refuse(std::string_view subject);
  /// Whether everything has been read. Then it is taken, and the reader is as new.
  [[nodiscard]] bool is_done(Clock::time_point now);
  /// All messages.
  std::vector<KeptMessage> take();
  /// Why it is not done for so long: what the broker has said last.
  [[nodiscard]] const std::string& trouble() const { return trouble_; }

 private:
  struct Part {
    std::string filter;
    std::uint64_t attempt = 0;
    Clock::time_point due{};  // of the request
    bool is_answered = false;
    bool is_done = false;
    std::uint64_t pending = 0;  // messages that were promised
    std::chrono::nanoseconds created{0};
    Clock::time_point heard{};
    std::vector<KeptMessage> messages{};
  };

  /// `<number>-<attempt>`: a request that is late must not be mixed up with the next one.
  static std::string token_of(std::uint64_t number, const Part& part);
  [[nodiscard]] std::string name_of(std::uint64_t number, const Part& part) const;
  void note(Part& part) const;

  const std::string answers_;
  const std::string messages_;
  const std::string name_;
  std::uint64_t last_number_ = 0;
  std::map<std::uint64_t, Part> parts_;  // by number
  std::string trouble_;
};

}  // namespace rr::gateway
