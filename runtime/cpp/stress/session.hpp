// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "rr/node.hpp"
#include "runtime/cpp/stress/faults.hpp"
#include "runtime/cpp/stress/socket_cutter.hpp"
#include "runtime/cpp/stress/watchdog.hpp"
#include "test/stress.hpp"

namespace rr::stress {

using Random = std::minstd_rand;
using test::stress::BenchStub;
using test::stress::PartStub;
using test::stress::Stamp;

/// What the sessions of a process have in common; outlives them.
struct ChannelContext {
  Lines& lines;
  Watchdog& watchdog;
  SocketCutter& cutter;
  const std::string url;
  std::atomic<std::uint64_t> sessions{0};
  std::atomic<std::uint64_t> calls{0};
  std::atomic<std::uint64_t> packets{0};
  std::atomic<std::uint64_t> values{0};
  std::atomic<std::uint64_t> events{0};
};

/// What a session shares with functions that may run a little longer than it.
struct SessionState {
  SessionState(ChannelContext& its_ground, const std::string& name);
  /// Whether a call may fail so: one that was open at the end with the first, a later one with the
  /// second when this side has closed.
  [[nodiscard]] bool excuses(const Error& error) const {
    return may_end && (error.code() == ErrorCode::connection_error ||
                       error.code() == ErrorCode::invalid_operation);
  }

  ChannelContext& context;
  Consecutive ticks;
  Consecutive broadcast;
  Consecutive echo;
  Rising level;
  Rising level_polled;
  Rising mirror;
  std::atomic<bool> may_end{false};  ///< the connection is about to be ended, or was
  std::atomic<bool> has_ended{false};
  std::atomic<int> ends_told{0};
  std::atomic<int> open_calls{0};  ///< asynchronous ones
};

/// A client from connecting to its end. `use()` does all of it in the calling thread, with a second
/// one at times.
class Session {
 public:
  Session(ChannelContext& context, Watchdog::Watched& watched, std::uint32_t client,
          std::uint32_t serial, std::uint32_t seed);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// `is_over` ends it early.
  void use(Node& shared, const std::function<bool()>& is_over);

 private:
  enum class End { close, cut, reset, sent_away, node };
  using Codes = std::initializer_list<ErrorCode>;

  // session.cpp
  bool connect(Node& node);
  void finish(End end);
  void expect_the_end(ErrorCode why);
  void wait_for(const char* what, const std::function<bool()>& holds);
  void attempt(const char* what, const std::function<void()>& action, Codes allowed = {});
  void check(bool holds, const char* what);
  [[nodiscard]] std::uint64_t draw(std::uint64_t below);

  // session_streams.cpp
  void connect_streams();
  void connect_wires();
  void send_packets();
  void send_values();
  void compare_level();
  void settle();
  void settle_stream(const char* what, const Consecutive& stream, std::uint64_t from,
                     std::uint64_t to);

  // session_calls.cpp
  void act();
  void call();
  void call_aside();
  void use_memory();
  void use_grid();
  void use_generator();
  void feed_generator();
  void use_part();
  void lock_part();
  void enter_part();
  void release_part();
  void run_companion();

  ChannelContext& context_;
  Watchdog::Watched& watched_;
  const std::uint32_t client_number_;
  const std::uint32_t place_;  // in the memories
  const std::string name_;
  Random random_;
  std::shared_ptr<SessionState> state_;
  Client<BenchStub> client_;
  std::shared_ptr<BenchStub> bench_;
  SocketCutter::Socket socket_;

  std::vector<Subscription> subscriptions_;
  PipeEndpoint<std::optional<Stamp>> broadcast_;
  PipeEndpoint<std::optional<Stamp>> echo_;
  PipeEndpoint<std::optional<Stamp>> lossy_;
  WireConnection<std::optional<Stamp>> level_;
  WireConnection<std::optional<Stamp>> mirror_;
  WireConnection<std::optional<Stamp>> target_;
  bool has_ticks_ = false;
  bool has_broadcast_ = false;
  bool has_echo_ = false;
  bool has_level_ = false;
  bool has_mirror_ = false;
  bool has_target_ = false;
  // What comes from these numbers on is complete: they were sent once all was connected.
  std::uint64_t ticks_from_ = 0;
  std::uint64_t broadcast_from_ = 0;
  std::uint64_t sent_echo_ = 0;
  std::uint64_t sent_mirror_ = 0;
  std::uint64_t sent_target_ = 0;
  std::vector<Generator<std::uint64_t>> open_generators_;

  std::atomic<bool> is_companion_ending_{false};
  std::thread companion_;
};

}  // namespace rr::stress
