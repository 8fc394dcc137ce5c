// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <future>
#include <memory>
#include <utility>
#include <vector>

#include "rr/client.hpp"
#include "rr/error.hpp"
#include "runtime/cpp/fuzz/promise.hpp"

namespace rr::fuzz {

/// What a program asks a service that may be hostile. Each thing ends with a value or an rr::Error
/// in time; anything else ends the fuzzer.
class Attempts {
 public:
  /// Does it, unless the service has kept the program waiting too often. Returns whether it has
  /// succeeded. What it throws besides rr::Error is thrown on.
  template <class Action>
  bool attempt(const Action& action) {
    if (timeouts_ >= most_timeouts) return false;
    const auto begin = Clock::now();
    bool is_done = false;
    try {
      action();
      is_done = true;
      outcomes_.push_back(0);
    } catch (const Error& error) {
      outcomes_.push_back(static_cast<int>(error.code()));
      if (error.code() == ErrorCode::request_timeout) ++timeouts_;
    }
    promise(Clock::now() - begin < limit, "what is asked ends in time");
    return is_done;
  }
  /// The same with what an asynchronous call is to complete.
  template <class Start>
  void attempt_async(const Start& start) {
    attempt([&] {
      auto future = start();
      promise(future.wait_for(limit) == std::future_status::ready, "a call completes in time");
      future.get();
    });
  }

  /// A session that must be gone after the run.
  void watch(const ClientBase& client) { sessions_.push_back(client.rr_session()); }
  [[nodiscard]] const std::vector<std::weak_ptr<Session>>& sessions() const { return sessions_; }
  /// 0 for what has succeeded, else the code of the error.
  [[nodiscard]] const std::vector<int>& outcomes() const { return outcomes_; }

 private:
  using Clock = std::chrono::steady_clock;
  // Far more than the node's time-outs: the machine may have no time for the fuzzer. The time-out
  // of the fuzzer itself is shorter as a rule.
  static constexpr std::chrono::seconds limit{30};
  static constexpr int most_timeouts = 2;

  std::vector<int> outcomes_;
  std::vector<std::weak_ptr<Session>> sessions_;
  int timeouts_ = 0;
};

}  // namespace rr::fuzz
