// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "rr/async.hpp"
#include "runtime/cpp/src/node/testing/counter.hpp"

/// The asynchronous members of the counter's stub; needs Boost.Asio, as generated ones do.
namespace rr::testing {

template <class Token>
auto CounterStub::async_get_value(Token&& token) {
  return rr_async_get<double>(rr_Counter.members[1], {}, std::forward<Token>(token));
}
template <class Token>
auto CounterStub::async_set_value(double value, Token&& token) {
  return rr_async_set<double>(rr_Counter.members[1], {}, std::forward<Token>(token), value);
}
template <class Token>
auto CounterStub::async_add(double a, double b, Token&& token) {
  return async_add(a, b, CallOptions(), std::forward<Token>(token));
}
template <class Token>
auto CounterStub::async_add(double a, double b, const CallOptions& options, Token&& token) {
  return rr_async_call<double>(rr_Counter.members[4], options, std::forward<Token>(token), a, b);
}
template <class Token>
auto CounterStub::async_echo(const std::string& text, Token&& token) {
  return rr_async_call<std::string>(rr_Counter.members[6], {}, std::forward<Token>(token), text);
}
template <class Token>
auto CounterStub::async_slow(std::int32_t milliseconds, Token&& token) {
  return async_slow(milliseconds, CallOptions(), std::forward<Token>(token));
}
template <class Token>
auto CounterStub::async_slow(std::int32_t milliseconds, const CallOptions& options, Token&& token) {
  return rr_async_call<void>(rr_Counter.members[11], options, std::forward<Token>(token),
                             milliseconds);
}
template <class Token>
auto CounterStub::async_raise(std::int32_t code, const std::string& text, Token&& token) {
  return rr_async_call<void>(rr_Counter.members[10], {}, std::forward<Token>(token), code, text);
}
template <class Token>
auto CounterStub::async_get_by_name(const std::string& index, Token&& token) {
  return rr_async_find<CounterStub>(rr_Counter.members[17], {}, std::forward<Token>(token), index);
}

}  // namespace rr::testing
