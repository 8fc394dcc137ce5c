// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "gateway/carrier.hpp"
#include "rr/function.hpp"

/// The far end of a stream: everything once, in order.
namespace rr::gateway {

/// Records that will not come any more.
struct StreamGap {
  std::uint64_t first = 0;  ///< number of the first one that is missing; 0: it is not known
  std::uint64_t last = 0;   ///< of the last one
};

/// What a reader wants of the writer.
struct StreamAsk {
  std::uint64_t from = 0;   ///< 0: from where this reader has confirmed
  std::uint64_t count = 0;  ///< records at most
};

/// Puts the messages of a StreamWriter in order, drops duplicates, finds gaps and asks for what is
/// missing. No threads, no clock, nothing on disk: where a reader goes on after a restart, the
/// writer knows.
class StreamReader {
 public:
  using Clock = std::chrono::steady_clock;
  /// How much is kept while something before it is missing, and how long to wait for an answer.
  struct Options {
    std::size_t records = 1024;
    std::size_t bytes = std::size_t{4} * 1024 * 1024;
    std::uint64_t ask_count = 256;
    std::chrono::milliseconds patience{500};             ///< at first, and at least
    std::chrono::milliseconds longest_patience{30'000};  ///< after several times in vain
  };
  /// What records become.
  struct Sink {
    Function<void(const Message&)> record;  ///< the next record, kind `data`
    Function<void(const StreamGap&)> gap;   ///< before the record that follows
  };

  /// The sink is called in receive() only.
  StreamReader(Sink sink, const Options& options) : sink_(std::move(sink)), options_(options) {}

  /// What records become from now on. Not in a function of the sink.
  void set_sink(Sink sink) { sink_ = std::move(sink); }
  /// A message of the stream, in any order, any number of times. Others are ignored.
  void receive(Message message, Clock::time_point now);
  /// What to ask for now; nothing for nothing. To be called after receive(), and some times in
  /// `patience`.
  std::optional<StreamAsk> ask(Clock::time_point now);
  /// The connection to the broker was made, or made again: something may be missing.
  void reconnected();
  /// The number to confirm; nothing when the writer knows it already, as far as it has said.
  [[nodiscard]] std::optional<std::uint64_t> unconfirmed() const;
  /// It was sent.
  void confirmed(std::uint64_t number) { sent_ = number; }
  /// Of the writer's log; 0 until it is known.
  [[nodiscard]] std::uint64_t epoch() const { return epoch_; }
  /// Numbers up to this one were given to the sink or reported as missing.
  [[nodiscard]] std::uint64_t position() const { return next_ - 1; }

 private:
  void take_head(const Message& message, std::uint64_t epoch, std::uint64_t number);
  void take_answer(const Message& message, std::uint64_t confirmed);
  void take(Message message, std::uint64_t number);
  void keep(Message message, std::uint64_t number);
  void hand_out(const Message& message, std::uint64_t number);
  void skip_to(std::uint64_t number);
  void forget();
  void take_answer_time(Clock::time_point now);

  Sink sink_;
  Options options_;
  std::uint64_t epoch_ = 0;
  std::uint64_t next_ = 1;  // the number that is waited for
  std::uint64_t known_last_ = 0;
  std::uint64_t sent_ = 0;  // confirmed
  std::map<std::uint64_t, Message> kept_;
  std::size_t kept_bytes_ = 0;
  bool must_ask_ = true;
  bool has_asked_ = false;
  std::uint64_t asked_until_ = 0;
  bool is_answered_ = false;   // the end of what was asked for has come
  Clock::time_point heard_{};  // when something was asked for, or was answered, last
  Clock::time_point asked_{};
  bool is_heard_ = true;      // an answer has come since
  bool is_repeated_ = false;  // none had come to what was asked for before
  std::chrono::milliseconds patience_ = options_.patience;
};

}  // namespace rr::gateway
