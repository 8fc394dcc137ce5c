// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "rr/error.hpp"
#include "rr/mutex.hpp"
#include "rr/skeleton.hpp"
#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/endpoint/core.hpp"
#include "runtime/cpp/src/service/object_tree.hpp"

namespace rr::service {

/// Who is in the monitors of a service's objects (07, section 6). Sessions that want to enter wait
/// in line, without a thread; for the first one, one thread asks the object itself. No user code
/// runs under the lock.
class Monitors final : public channel::Timer, public std::enable_shared_from_this<Monitors> {
 public:
  enum class Outcome { entered, wait_on, failed };
  /// Called once for each enter() and go_on() that does not throw. The error is that of `failed`.
  using Reply = std::function<void(Outcome, const Error*)>;

  /// Sessions that do not use what they hold for `patience` lose it. Each is in at most `limit`
  /// monitors or lines.
  Monitors(std::shared_ptr<endpoint::Core> core, channel::Milliseconds patience, std::size_t limit);
  ~Monitors();

  /// Gets in line; a negative time-out is none. After 5 s the reply is to wait on. Throws
  /// rr::Error: invalid_operation when the session is in, or in line, out_of_system_resource when
  /// it is in too many.
  void enter(const ServedObject& object, std::uint32_t endpoint, channel::Milliseconds timeout,
             Reply reply);
  /// Throws rr::Error (invalid_operation) when the session is neither in nor in line.
  void go_on(const ServedObject& object, std::uint32_t endpoint, Reply reply);
  /// Leaves, or gets out of the line. False when nobody ever was in. Throws rr::Error
  /// (invalid_operation) when the session is neither.
  bool exit(const ServedObject& object, std::uint32_t endpoint);

  /// The client of a session has gone: it gets out of all lines, and out of what it holds later.
  void leave_lines(std::uint32_t endpoint);
  /// A session ends. Runs user code, as do exit() and forget().
  void leave(std::uint32_t endpoint);
  /// A session may not be in those at paths for which `is_over` holds, nor in line for them, which
  /// fails with `why`. Returns how many they were. Runs user code.
  std::size_t end_if(std::uint32_t endpoint, const std::function<bool(const std::string&)>& is_over,
                     const Error& why);
  /// An object goes away.
  void forget(const ServedObject& object);

  /// Whether anybody is in any.
  [[nodiscard]] bool are_held() const { return held_.load(std::memory_order_acquire) != 0; }
  /// Throws rr::Error (invalid_operation) when another session is in. Notes that it is used.
  void check(const ServedObject& object, std::uint32_t endpoint);

 private:
  class Attempt;
  struct Monitor {
    std::shared_ptr<Skeleton> skeleton;
    std::uint32_t holder = 0;
    channel::Time used{};
    bool is_busy = false;  // a thread asks or leaves the object
    std::deque<std::shared_ptr<Attempt>> line;
    std::map<std::uint32_t, Error> failures;  // not told yet
  };
  using Replies = std::vector<std::function<void()>>;

  void on_timer() override;
  void drop_unused();
  void check_count(std::uint32_t endpoint) const RR_REQUIRES(mutex_);
  void step(const std::shared_ptr<Monitor>& monitor, const std::shared_ptr<Attempt>& attempt);
  void ask(const std::shared_ptr<Monitor>& monitor);
  void give_back(const std::shared_ptr<Monitor>& monitor);
  void admit_next(const std::shared_ptr<Monitor>& monitor);
  void fail(Monitor& monitor, Attempt& attempt, const Error& error, Replies& replies)
      RR_REQUIRES(mutex_);
  bool take_out(Monitor& monitor, const Attempt& attempt) RR_REQUIRES(mutex_);
  bool begin_exit(Monitor& monitor, std::uint32_t endpoint) RR_REQUIRES(mutex_);
  void await(const std::shared_ptr<Attempt>& attempt, Reply reply) RR_REQUIRES(mutex_);
  void leave_object(const Monitor& monitor);
  void schedule_drop() RR_REQUIRES(mutex_);
  static std::shared_ptr<Attempt> find_attempt(const Monitor& monitor, std::uint32_t endpoint);
  std::shared_ptr<Monitor> find(const ServedObject& object) RR_REQUIRES(mutex_);
  void post(std::function<void()> work);

  const std::shared_ptr<endpoint::Core> core_;
  const channel::Milliseconds patience_;
  const std::size_t limit_;
  std::atomic<int> held_{0};
  Mutex mutex_;
  // By path, and by the client whose own the object is.
  using Place = std::pair<std::string, std::uint32_t>;
  std::map<Place, std::shared_ptr<Monitor>> monitors_ RR_GUARDED_BY(mutex_);
};

}  // namespace rr::service
