// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <exception>
#include <memory>
#include <type_traits>
#include <utility>

#include "rr/async/completion.hpp"
#include "rr/skeleton.hpp"
#include "rr/stub.hpp"
#include "rr/visibility.hpp"

/// Properties, functions, objrefs and callbacks; see rr/async.hpp.
namespace RR_VISIBLE rr {

/// Shows that this header is there: see AsyncHeaderIsIncluded.
template <class Token>
struct AsyncCalls {};

/// Of the search for an object.
template <class Handler, class S>
class FindCompletion final : public HandlerCompletion<Handler> {
 public:
  /// Ends at `handler`; `member` is the objref that is followed.
  FindCompletion(Handler handler, const Member& member)
      : HandlerCompletion<Handler>(std::move(handler)), member_(&member) {}
  void* result() override { return &found_; }
  void succeed() override {
    auto stub = std::dynamic_pointer_cast<S>(std::move(found_));
    if (stub) {
      this->finish(std::exception_ptr(), std::move(stub));
      return;
    }
    try {
      Stub::rr_refuse(*member_);
    } catch (...) {
      fail(std::current_exception());
    }
  }
  void fail(std::exception_ptr error) override {
    this->finish(std::move(error), std::shared_ptr<S>());
  }

 private:
  const Member* member_;
  std::shared_ptr<Stub> found_;
};

template <class R, class Token, class... Arguments>
requires AsyncHeaderIsIncluded<Token>
auto Stub::rr_async_call(const Member& member, const CallOptions& options, Token&& token,
                         const Arguments&... arguments) {
  return boost::asio::async_initiate<Token, typename CompletionSignature<R>::type>(
      [this, call = &member, options](auto&& handler, const Arguments&... values) {
        using Handler = std::decay_t<decltype(handler)>;
        const void* const places[] = {&values..., nullptr};
        start_call(
            std::make_unique<CallCompletion<Handler, R>>(std::forward<decltype(handler)>(handler)),
            options,
            [&](auto completion) { rr_start(*call, false, places, std::move(completion)); });
      },
      token, arguments...);
}

template <class T, class Token>
requires AsyncHeaderIsIncluded<Token>
auto Stub::rr_async_get(const Member& member, const CallOptions& options, Token&& token) {
  return boost::asio::async_initiate<Token, void(std::exception_ptr, T)>(
      [this, property = &member, options](auto&& handler) {
        using Handler = std::decay_t<decltype(handler)>;
        start_call(
            std::make_unique<CallCompletion<Handler, T>>(std::forward<decltype(handler)>(handler)),
            options,
            [&](auto completion) { rr_start(*property, false, nullptr, std::move(completion)); });
      },
      token);
}

template <class T, class Token>
requires AsyncHeaderIsIncluded<Token>
auto Stub::rr_async_set(const Member& member, const CallOptions& options, Token&& token,
                        const T& value) {
  return boost::asio::async_initiate<Token, void(std::exception_ptr)>(
      [this, property = &member, options](auto&& handler, const T& wanted) {
        using Handler = std::decay_t<decltype(handler)>;
        const void* const place = &wanted;
        start_call(std::make_unique<CallCompletion<Handler, void>>(
                       std::forward<decltype(handler)>(handler)),
                   options, [&](auto completion) {
                     rr_start(*property, true, &place, std::move(completion));
                   });
      },
      token, value);
}

template <class S, class Token, class... Index>
requires AsyncHeaderIsIncluded<Token>
auto Stub::rr_async_find(const Member& member, const CallOptions& options, Token&& token,
                         const Index&... index) {
  return boost::asio::async_initiate<Token, void(std::exception_ptr, std::shared_ptr<S>)>(
      [this, objref = &member, options](auto&& handler, const auto&... wanted) {
        using Handler = std::decay_t<decltype(handler)>;
        start_call(std::make_unique<FindCompletion<Handler, S>>(
                       std::forward<decltype(handler)>(handler), *objref),
                   options, [&](auto completion) {
                     rr_start_find(*objref, wanted..., std::move(completion));
                   });
      },
      token, index...);
}

template <class R, class Token, class... Arguments>
requires AsyncHeaderIsIncluded<Token>
auto Skeleton::rr_async_call_back(const Member& member, const CallOptions& options, Token&& token,
                                  std::uint32_t client, const Arguments&... arguments) const {
  return boost::asio::async_initiate<Token, typename CompletionSignature<R>::type>(
      [this, callback = &member, options, client](auto&& handler, const Arguments&... values) {
        using Handler = std::decay_t<decltype(handler)>;
        const void* const places[] = {&values..., nullptr};
        start_call(
            std::make_unique<CallCompletion<Handler, R>>(std::forward<decltype(handler)>(handler)),
            options, [&](auto completion) {
              rr_start_asking(*callback, client, places, std::move(completion));
            });
      },
      token, arguments...);
}

}  // namespace rr
