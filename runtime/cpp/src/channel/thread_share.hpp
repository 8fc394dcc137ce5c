// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>

#include "runtime/cpp/src/channel/time.hpp"

namespace rr::channel {

/// How a handler may run that the polling thread has come upon.
enum class Handling : std::uint8_t {
  in_place,  ///< here; should it block, another thread takes over polling
  aside,     ///< here, when another thread polls already: it will take long
  later,     ///< not now: it waits in the queue of its session
};

/// How the threads of a node are used when one more may be wanted: what admission goes by.
struct ThreadUse {
  unsigned free = 0;             ///< threads that could still take over
  unsigned reserve = 0;          ///< of these, kept for sessions that hold none
  unsigned most = 0;             ///< threads that handlers may hold, all together
  unsigned held = 0;             ///< held now by handlers that block
  unsigned held_by_address = 0;  ///< the same of all sessions of one remote address
  unsigned held_by_session = 0;
  unsigned session_limit = 0;
};

/// What is known of a session's handlers.
enum class Pace : std::uint8_t {
  unknown,
  quick,  ///< its last ones were short
  slow,   ///< they have blocked the polling thread
};

/// Decides who may hold one more thread (docs/decisions/0020-shares-of-threads.md).
Handling admit(const ThreadUse& use, Pace pace);

/// All connections of one remote address. The reactor's lock guards `held`.
struct AddressThreads {
  explicit AddressThreads(std::string remote_key) : key(std::move(remote_key)) {}
  const std::string key;
  unsigned held = 0;
  std::atomic<Time> last_stall{Time::min()};  ///< when a handler last blocked the polling thread
};

/// The remote addresses that connections are open from, or were a while ago. No lock of itself.
class AddressTable {
 public:
  /// The one with this key, for as long as somebody keeps it.
  std::shared_ptr<AddressThreads> open(const std::string& key);
  /// Addresses, those without a connection that were not swept yet too.
  [[nodiscard]] std::size_t size() const { return addresses_.size(); }

 private:
  std::unordered_map<std::string, std::weak_ptr<AddressThreads>> addresses_;
  std::size_t swept_ = 0;  // that were left of them
};

/// The threads that handlers of one connection hold, and how long they use to take. A handler holds
/// a thread while it keeps it from polling.
class ThreadShare {
 public:
  explicit ThreadShare(std::shared_ptr<AddressThreads> address);

  // Of the thread that hands messages to the connection's receiver, one at a time.
  /// A handler, or several in a row, have ended. `is_long`: the coarse clock has ticked meanwhile.
  void ran(bool is_long);
  [[nodiscard]] Pace pace() const;
  [[nodiscard]] bool is_slow() const { return is_slow_.load(std::memory_order_relaxed); }
  /// Nothing is held and nothing bad is known.
  [[nodiscard]] bool is_inconspicuous() const {
    return !is_slow_.load(std::memory_order_relaxed) && held_.load(std::memory_order_relaxed) == 0;
  }

  /// The polling thread was found in a handler for long. On any thread. One such handler among
  /// short ones does not make the session slow.
  void note_stall(Time now);
  /// The connection has ended: what is left of it is short.
  void depart() { has_departed_.store(true, std::memory_order_relaxed); }
  [[nodiscard]] bool has_departed() const { return has_departed_.load(std::memory_order_relaxed); }

  // Under the reactor's lock.
  void hold();
  void release();
  [[nodiscard]] unsigned held() const { return held_.load(std::memory_order_relaxed); }
  [[nodiscard]] unsigned held_by_address() const { return address_->held; }

 private:
  // Long ones count more than short ones make up for: handlers of half a millisecond are slow.
  static constexpr std::uint32_t cost_of_long = 8;
  static constexpr std::uint32_t slow_from = 64;
  static constexpr std::uint32_t forgiven = 48;  // cost of a stall among short handlers
  static constexpr std::uint32_t largest_cost_of_stall = 1024;
  static constexpr std::uint32_t most_slowness = 4096;
  static constexpr std::uint32_t quick_from = 16;

  void add_slowness(std::uint32_t cost);

  const std::shared_ptr<AddressThreads> address_;
  std::atomic<unsigned> held_{0};
  std::atomic<bool> is_slow_{false};
  std::atomic<bool> has_departed_{false};
  std::atomic<std::uint32_t> slowness_{0};  // so many short ones are owed
  std::atomic<std::uint32_t> calm_{0};      // short ones in a row, up to quick_from
  std::atomic<std::uint32_t> cost_of_stall_{slow_from};
};

}  // namespace rr::channel
