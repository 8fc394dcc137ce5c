// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/call_terms.hpp"

#include <algorithm>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/endpoint/calls.hpp"

namespace rr {
namespace {

thread_local const CallScope* innermost_scope = nullptr;

}  // namespace

Cancellation::Cancellation() : state_(std::make_shared<State>()) {}
void Cancellation::cancel() { state_->cancel(); }
bool Cancellation::is_cancelled() const { return state_->is_cancelled(); }

CallScope::CallScope(std::chrono::milliseconds timeout)
    : timeout_(timeout), outer_(std::exchange(innermost_scope, this)) {}
CallScope::CallScope(const Cancellation& cancellation)
    : cancellation_(cancellation.state()), outer_(std::exchange(innermost_scope, this)) {}
CallScope::CallScope(std::chrono::milliseconds timeout, const Cancellation& cancellation)
    : timeout_(timeout),
      cancellation_(cancellation.state()),
      outer_(std::exchange(innermost_scope, this)) {}
CallScope::~CallScope() { innermost_scope = outer_; }

CallTerms CallTerms::current() {
  CallTerms terms;
  for (const CallScope* scope = innermost_scope; scope != nullptr; scope = scope->outer_) {
    if (terms.timeout.count() == 0) terms.timeout = scope->timeout_;
    if (!terms.cancellation) terms.cancellation = scope->cancellation_;
  }
  return terms;
}

CallTerms::Suspended::Suspended() : scope_(std::exchange(innermost_scope, nullptr)) {}
CallTerms::Suspended::~Suspended() { innermost_scope = scope_; }

void Cancellation::State::add(std::shared_ptr<endpoint::Caller> caller, endpoint::Pending& call) {
  const std::lock_guard lock(mutex_);
  if (is_cancelled_) throw Error(ErrorCode::operation_cancelled, "the call was cancelled");
  calls_.push_back({std::move(caller), &call});
}

void Cancellation::State::remove(const endpoint::Pending& call) {
  std::shared_ptr<endpoint::Caller>
      caller;  // goes when the lock has, with what the program gave it
  const std::lock_guard lock(mutex_);
  const auto found = std::find_if(calls_.begin(), calls_.end(),
                                  [&](const Call& item) { return item.pending == &call; });
  if (found == calls_.end()) return;
  caller = std::move(found->caller);
  calls_.erase(found);
}

void Cancellation::State::cancel() {
  std::vector<std::pair<std::shared_ptr<endpoint::Caller>, channel::Laters>> left_over;
  {
    const std::lock_guard lock(mutex_);
    is_cancelled_ = true;
    for (const Call& call : calls_) {
      left_over.emplace_back(call.caller, channel::Laters());
      call.caller->cancel(*call.pending, left_over.back().second);
    }
  }
  for (auto& [caller, laters] : left_over) caller->post(std::move(laters));
}

bool Cancellation::State::is_cancelled() {
  const std::lock_guard lock(mutex_);
  return is_cancelled_;
}

}  // namespace rr
