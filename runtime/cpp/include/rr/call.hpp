// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <concepts>
#include <coroutine>
#include <functional>
#include <stop_token>
#include <type_traits>
#include <utility>

#include "rr/visibility.hpp"

namespace RR_VISIBLE rr {

/// How long one call may take, and what ends it before its answer comes. The last parameter of
/// members that call the other side, and the one before the token of their asynchronous forms:
///
///   arm->move_to(0.5, 0.1, rr::within(2s));
///   arm->move_to(0.5, 0.1, {.timeout = 2s, .stop = thread.get_stop_token()});
///   co_await arm->async_move_to(0.5, 0.1, rr::within(2s), boost::asio::use_awaitable);
///
/// Both end the waiting only: the service is not told and finishes its work.
struct CallOptions {
  /// Then the call fails with request_timeout. 0: what the stub, the client or the node say;
  /// milliseconds::max(): no limit.
  std::chrono::milliseconds timeout{0};
  /// When a stop is requested, from any thread, the call fails with operation_cancelled.
  std::stop_token stop{};
};

/// Options with a time limit, and a stop token if one is given: `arm->move_to(1, 0,
/// rr::within(2s))`.
[[nodiscard]] inline CallOptions within(std::chrono::milliseconds timeout,
                                        std::stop_token stop = {}) {
  return {timeout, std::move(stop)};
}
/// Options without a time limit of their own, whose call a stop token ends.
[[nodiscard]] inline CallOptions stopped_by(std::stop_token stop) {
  return {std::chrono::milliseconds(0), std::move(stop)};
}

/// Internal: options of the calls that this thread begins while the object exists. It is made and
/// destroyed within one function that does not return in between.
class CallOptionsScope {
 public:
  /// What the scope counts for: `blocking_calls` only, or `all_calls`.
  enum class Reach : bool { blocking_calls, all_calls };

  /// `options` stay where they are.
  explicit CallOptionsScope(const CallOptions& options, Reach reach = Reach::all_calls);
  ~CallOptionsScope();
  CallOptionsScope(const CallOptionsScope&) = delete;
  CallOptionsScope& operator=(const CallOptionsScope&) = delete;

 private:
  friend struct CallTerms;
  const CallOptions* const options_;
  const CallOptionsScope* const outer_;
  const Reach reach_;
};

/// What a coroutine returns: something whose work goes on after the function has returned.
template <class R>
concept Awaitable = requires {
  typename std::coroutine_traits<R>::promise_type;
}
|| requires(R& result) { result.await_ready(); }
|| requires(R&& result) { std::forward<R>(result).operator co_await(); }
|| requires(R&& result) { operator co_await(std::forward<R>(result)); };

/// Calls `function()` and returns what it returns. Blocking calls that it makes on this thread take
/// `options` for what they are not told themselves; an inner with_options() for what it does not
/// say. Asynchronous calls take none of it, and coroutines are refused: they may go on elsewhere.
template <std::invocable Function>
requires(!Awaitable<std::invoke_result_t<Function>>) decltype(auto)
    with_options(const CallOptions& options, Function&& function) {
  const CallOptionsScope scope(options, CallOptionsScope::Reach::blocking_calls);
  return std::invoke(std::forward<Function>(function));
}

/// Complete where rr/async.hpp is included.
template <class Token>
struct AsyncCalls;

/// What functions named `async_...` require: that `#include <rr/async.hpp>` comes before they are
/// called.
template <class Token>
concept AsyncHeaderIsIncluded = requires {
  sizeof(AsyncCalls<Token>);
};  // #include <rr/async.hpp>

}  // namespace rr
