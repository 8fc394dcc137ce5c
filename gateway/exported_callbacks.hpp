// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <future>
#include <map>
#include <memory>
#include <string>

#include "gateway/carrier.hpp"
#include "gateway/outbox.hpp"
#include "gateway/worker.hpp"
#include "rr/function.hpp"
#include "rr/mutex.hpp"

namespace rr::gateway {

/// Functions of far clients that the robot calls: each call is repeated until there is an answer or
/// the time is over. All repetitions have the same id, so that the serving gateway calls once.
class ExportedCallbacks : public std::enable_shared_from_this<ExportedCallbacks> {
 public:
  using Clock = std::chrono::steady_clock;
  /// What the robot may make this keep, and for how long.
  struct Limits {
    std::size_t waiting = 64;  ///< each of them holds a thread of the node
    std::chrono::milliseconds time{10'000};
    std::chrono::milliseconds repeat{1'000};
  };

  /// `pump` is called when something is to be published. What is referred to outlives this.
  ExportedCallbacks(Worker& worker, Outbox& outbox, const Limits& limits, Function<void()> pump);

  /// Publishes the call of a client of this user, and waits for its answer: the payload of its
  /// result. Throws rr::Error: that of the client, request_timeout, out_of_system_resource. Any
  /// thread but the worker's.
  Bytes wait(const std::string& user, Message call);

  // The rest on the worker's thread.

  /// An answer, of a user of the broker. Ignored when nothing waits for it.
  void take(const std::string& user, const Message& answer);
  /// Repeats what waits, and gives up what is too late.
  void tick(Clock::time_point now);
  /// All that waits fails, and all that comes (operation_aborted). Any thread.
  void abort();

 private:
  struct Pending {
    std::string user;
    Message message;
    std::promise<Bytes> result;
    Clock::time_point end;
    Clock::time_point next;
  };
  void finish(const std::string& id, const std::exception_ptr& error, const Bytes& payload);

  Worker& worker_;
  Outbox& outbox_;
  const Limits limits_;
  const Function<void()> pump_;
  Mutex mutex_;
  std::map<std::string, Pending> pending_ RR_GUARDED_BY(mutex_);  // by id
  bool is_aborted_ RR_GUARDED_BY(mutex_) = false;
};

}  // namespace rr::gateway
