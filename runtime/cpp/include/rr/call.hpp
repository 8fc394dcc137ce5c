// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <utility>

namespace rr {

/// Ends calls before their answers come: they fail with operation_cancelled. The service is not
/// told and finishes its work.
class Cancellation {
 public:
  Cancellation();
  /// Ends all calls made with this, now and from now on. From any thread; does not wait.
  void cancel();
  [[nodiscard]] bool is_cancelled() const;

  struct State;  // internal
  explicit Cancellation(std::shared_ptr<State> state) : state_(std::move(state)) {}
  [[nodiscard]] const std::shared_ptr<State>& state() const { return state_; }

 private:
  std::shared_ptr<State> state_;
};

/// Time-out and cancellation of the calls, blocking and asynchronous, that this thread starts while
/// the object exists:
///
///   rr::CallScope scope(2s, stop);
///   arm->move_to(0.5, 0.1);
///
/// What a scope does not say is as in the one around it.
class CallScope {
 public:
  /// milliseconds::max() means no limit.
  explicit CallScope(std::chrono::milliseconds timeout);
  explicit CallScope(const Cancellation& cancellation);
  CallScope(std::chrono::milliseconds timeout, const Cancellation& cancellation);
  ~CallScope();
  CallScope(const CallScope&) = delete;
  CallScope& operator=(const CallScope&) = delete;

 private:
  std::chrono::milliseconds timeout_{0};
  std::shared_ptr<Cancellation::State> cancellation_;
  const CallScope* outer_;

  friend struct CallTerms;
};

}  // namespace rr
