// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "rr/skeleton.hpp"
#include "rr/visibility.hpp"

namespace RR_VISIBLE rr {

/// The answer to one call of a function, as the async_ member of a skeleton gets it: give it at
/// once, or take a Reply and give it later, from any thread:
///
///   void async_scan(double range, rr::Answer<Points> answer) override {
///     workers.post([range, reply = answer.defer()]() mutable { reply(scan_slowly(range)); });
///   }
///
/// Exactly one of the two. A member that throws before it does either answers with what it threw.
template <class R>
class Answer {
 public:
  /// For generated code: answers this request.
  Answer(Request& request) : request_(&request) {}  // NOLINT: rr_dispatch passes its request on

  /// Answers the call with its result. Throws rr::Error when that cannot be sent.
  void operator()(const R& result) { request_->answer(&result); }
  /// The next request of this client is handled meanwhile.
  [[nodiscard]] Reply<R> defer() { return Reply<R>(request_->defer()); }

 private:
  Request* request_;
};

/// The answer to one call of a function that returns nothing.
template <>
class Answer<void> {
 public:
  /// For generated code: answers this request.
  Answer(Request& request) : request_(&request) {}  // NOLINT: rr_dispatch passes its request on

  /// Answers the call: it is done.
  void operator()() { request_->answer(nullptr); }
  /// To answer later. The next request of this client is handled meanwhile.
  [[nodiscard]] Reply<void> defer() { return Reply<void>(request_->defer()); }

 private:
  Request* request_;
};

}  // namespace rr
