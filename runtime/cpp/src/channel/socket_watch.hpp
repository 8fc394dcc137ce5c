// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/channel/transition.hpp"
#include "runtime/cpp/src/channel/watcher.hpp"

namespace rr::channel {

/// What the reactor watches the socket of one connection for.
///
/// While a caller reads, input is not watched for: the reactor would be woken by every answer.
/// Calls in a tight loop find the socket idle, and leave it so; look(), called every few
/// milliseconds, has it watched again when calls have ceased. A thread of the reactor that is
/// pinned to the connection waits for input in receives that block; look() finds out when one of
/// its handlers takes long.
///
/// All of it under the connection's lock, which the caller has.
class SocketWatch {
 public:
  enum class State : std::uint8_t {
    off,   ///< the connection has not begun, or has ended
    full,  ///< for input and for room to send
    idle,  ///< for room only, and only while something waits to be sent
  };
  /// All changes of the state; as Strand::transitions().
  static std::span<const Transition<State>> transitions();

  /// Functions that return "must_look" want look() to be called after period().
  SocketWatch(Watcher& watcher, int socket, Pollable& pollable)
      : watcher_(watcher), socket_(socket), pollable_(pollable) {}
  SocketWatch(const SocketWatch&) = delete;
  SocketWatch& operator=(const SocketWatch&) = delete;

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] bool is_full() const { return state_ == State::full; }

  // `has_unsent`: something waits for room.
  /// The socket is a bell, for input and for room: it has input then. Its end is watched for
  /// always, since whoever reads may sleep where it does not show.
  void use_bell(bool has_unsent);
  /// The connection begins. A client's is idle: its first call follows at once and reads by itself.
  void begin(bool is_idle, bool has_unsent);
  void end();
  /// Whoever has the read lease waits for input itself.
  void go_idle(bool has_unsent);
  /// Nobody reads. The reactor also reports input that has already arrived.
  void go_full(bool has_unsent);
  /// Room is watched for, or is no longer.
  void update(bool has_unsent);
  /// A caller has ended reading, and nobody goes on. `last_received`: when its answer came; a call
  /// that ended in the same tick of the clock as the one before is taken for one of many, which
  /// find the socket idle. `uses`: of the read lease. `has_more`: there may be input that nobody
  /// has seen. Returns must_look.
  [[nodiscard]] bool end_call(Time last_received, std::uint32_t uses, bool has_more,
                              bool has_unsent);

  [[nodiscard]] bool is_pinned() const { return is_pinned_; }
  /// A thread of the reactor waits for input in receives that block, from now on or once more.
  /// Returns must_look.
  [[nodiscard]] bool pin(std::uint32_t uses, bool has_unsent);
  void unpin() { is_pinned_ = false; }

  enum class Look : std::uint8_t {
    later,  ///< once more, after period()
    done,   ///< there is nothing to look after
    stuck,  ///< a handler of the pinned thread takes long
  };
  /// `is_read`: somebody has the read lease.
  Look look(std::uint32_t uses, bool is_read, bool has_unsent);
  /// How long a socket stays idle without a call, or in the same handler. Grows while calls go on:
  /// each look takes some microseconds from the caller's processor, and with one in a hundred calls
  /// it would show in their p99.
  [[nodiscard]] Milliseconds period() const {
    return Milliseconds(is_pinned_ ? pinned_period : period_);
  }

 private:
  void become(State state, bool has_unsent);
  void watch(bool has_unsent);
  [[nodiscard]] std::uint32_t wanted(bool has_unsent) const;
  bool must_look(std::uint32_t uses);

  // Milliseconds; small, as there is one for each connection.
  static constexpr std::uint8_t first_period = 1;
  static constexpr std::uint8_t longest_period = 16;
  static constexpr std::uint8_t pinned_period = 20;

  Watcher& watcher_;
  const int socket_;
  Pollable& pollable_;
  State state_ = State::off;
  std::uint8_t period_ = first_period;
  bool is_registered_ = false;  // with the watcher, for anything
  bool is_looked_at_ = false;   // look() will be called
  bool is_pinned_ = false;
  bool is_bell_ = false;
  std::uint32_t seen_uses_ = 0;
  Time last_call_{};
};

}  // namespace rr::channel
