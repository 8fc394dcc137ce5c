// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/cpp/src/serial/frames.hpp"

/// The host's end of the serial protocol: sessions, requests, time-outs. It has no clock, no port
/// and no thread; whoever has them tells it what came and when. Not to be used by two threads at
/// once.
namespace rr::serial {

/// Since any beginning.
using Time = std::chrono::microseconds;

/// How quick a line and the board at its end are.
struct LinkTiming {
  std::uint32_t baud = 0;
  /// What a board may need for an answer besides the line: the first time, the second, and each
  /// further one. Then the request is sent again.
  std::array<Time, 3> allowances{};
  /// How long a board may be silent when it is asked whether it is there.
  Time silence{};

  static LinkTiming of_serial(std::uint32_t baud) {
    using std::chrono::milliseconds;
    return {.baud = baud,
            .allowances = {milliseconds(10), milliseconds(20), milliseconds(40)},
            .silence = milliseconds(1000)};
  }
  /// TCP loses nothing and sends again by itself, but a radio may stop for a moment.
  static LinkTiming of_tcp() {
    using std::chrono::milliseconds;
    return {.baud = 1'000'000,
            .allowances = {milliseconds(200), milliseconds(400), milliseconds(800)},
            .silence = milliseconds(3000)};
  }
};

/// What a board says in answer to Hello.
struct BoardFacts {
  std::uint8_t longest_request = 0;
  std::uint8_t longest_reply = 0;
  std::uint8_t texts = 0;
  std::uint64_t hash = 0;
};

/// How a request ended.
struct Outcome {
  enum class Kind {
    reply,     ///< `body` is that of the Reply
    error,     ///< `code` is that of the Error
    reset,     ///< the board has begun anew: whether it was carried out is not known
    timeout,   ///< no answer: likewise
    version,   ///< of Hello: the board speaks version `code`
    too_long,  ///< never sent: the board takes shorter bodies; `reason` says how long
  };
  Kind kind{};
  std::uint8_t code = 0;
  std::vector<std::uint8_t> body{};
  /// Of an error: whether the board can say why. Text `reasonText` does, until the next request for
  /// a member.
  bool has_reason = false;
  std::string reason{};  ///< of an error or too_long, in words; may be empty
};

/// An event, a packet, a callback or a value of a wire.
struct Unasked {
  Kind kind{};
  std::vector<std::uint8_t> body{};
};

class HostLink {
 public:
  explicit HostLink(std::uint32_t baud) : HostLink(LinkTiming::of_serial(baud)) {}
  explicit HostLink(const LinkTiming& timing) : timing_(timing) {}

  /// Begins a session; its outcome is that of a request. `session` is not 0 and not the last one.
  void begin_session(std::uint16_t session, Time now, Time patience);
  /// Begins a request, when none is under way. It is sent again until it is answered, until
  /// `patience` has passed or until the board turns out to be reset. Not without a session.
  void request(Kind kind, std::vector<std::uint8_t> body, Time now, Time patience);
  /// Takes bytes of the line.
  void receive(std::span<const std::uint8_t> bytes, Time now);
  /// What is to be done at this time.
  void tick(Time now);
  /// When tick() has something to do; nothing while it has not.
  [[nodiscard]] std::optional<Time> wake_up() const;

  /// Bytes for the line, which are forgotten here.
  std::vector<std::uint8_t> take_output();
  /// The outcome of the request, once.
  std::optional<Outcome> take_outcome();
  /// What the board has sent without being asked, in order; while there is an outcome, only what it
  /// has sent before that.
  std::vector<Unasked> take_unasked();

  [[nodiscard]] bool is_busy() const { return is_busy_; }
  [[nodiscard]] bool has_session() const { return has_session_; }
  [[nodiscard]] const BoardFacts& facts() const { return facts_; }
  /// When something good came last.
  [[nodiscard]] Time heard() const { return heard_; }
  /// The number of the request that was begun last; Ask refers to it.
  [[nodiscard]] std::uint8_t sequence() const { return sequence_; }
  /// Frames sent again.
  [[nodiscard]] std::uint64_t repeated() const { return repeated_; }
  [[nodiscard]] std::uint64_t dropped() const { return finder_.dropped(); }
  /// The port is another one, or was closed: what had been begun is gone.
  void lose_session();

 private:
  void start(Frame frame, Time now, Time patience);
  void send(Time now);
  void finish(Outcome outcome);
  void handle(const Frame& frame);
  void handle_answer(const Frame& frame);
  void handle_hello(const Frame& frame);
  void handle_unasked(const Frame& frame);
  [[nodiscard]] Time on_wire(std::size_t bytes) const;

  const LinkTiming timing_;
  FrameFinder finder_;
  std::vector<std::uint8_t> output_;
  std::vector<Unasked> unasked_;
  std::optional<Outcome> outcome_;
  std::size_t before_outcome_ = 0;  // so many of unasked_
  BoardFacts facts_;

  bool has_session_ = false;
  bool is_busy_ = false;
  std::uint16_t session_ = 0;
  std::uint8_t sequence_ = 0;
  std::optional<std::uint8_t> unasked_sequence_;
  Frame under_way_;
  unsigned attempts_ = 0;
  std::uint64_t repeated_ = 0;
  Time again_{};
  Time give_up_{};
  Time heard_{};
};

}  // namespace rr::serial
