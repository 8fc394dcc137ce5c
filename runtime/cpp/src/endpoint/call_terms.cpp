// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/call_terms.hpp"

#include <utility>

namespace rr {
namespace {

thread_local const CallOptionsScope* innermost_scope = nullptr;

}  // namespace

[[gnu::hot]] CallOptionsScope::CallOptionsScope(const CallOptions& options, Reach reach)
    : options_(&options), outer_(std::exchange(innermost_scope, this)), reach_(reach) {}
[[gnu::hot]] CallOptionsScope::~CallOptionsScope() { innermost_scope = outer_; }

void CallTerms::add(const CallOptions& options) {
  if (timeout.count() == 0) timeout = options.timeout;
  if (!stop.stop_possible()) stop = options.stop;
}

[[gnu::hot]] CallTerms CallTerms::of_blocking_call() {
  CallTerms terms;
  for (auto* scope = innermost_scope; scope != nullptr; scope = scope->outer_) {
    terms.add(*scope->options_);
  }
  return terms;
}

CallTerms CallTerms::of_started_call() {
  CallTerms terms;
  for (auto* scope = innermost_scope; scope != nullptr; scope = scope->outer_) {
    if (scope->reach_ == CallOptionsScope::Reach::all_calls) terms.add(*scope->options_);
  }
  return terms;
}

CallTerms::Suspended::Suspended() : scope_(std::exchange(innermost_scope, nullptr)) {}
CallTerms::Suspended::~Suspended() { innermost_scope = scope_; }

}  // namespace rr
