// SPDX-License-Identifier: Apache-2.0
#pragma once

// First: the Boost headers of some releases use std::exchange without including it.
// clang-format off
#include <utility>
// clang-format on

#include <boost/asio/associated_executor.hpp>
#include <boost/asio/async_result.hpp>
#include <boost/asio/dispatch.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <exception>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>

#include "rr/client.hpp"
#include "rr/node.hpp"
#include "rr/stub.hpp"

/// The asynchronous forms of calls, for any completion token of Boost.Asio: a callback, use_future,
/// use_awaitable. The only header that includes Asio; a program that uses no `async_` member does
/// without it.
///
///   mount->async_move_to(0.5, 0.1, [](std::exception_ptr error) { ... });
///   std::future<double> pan = mount->async_get_pan(boost::asio::use_future);
///   double tilt = co_await mount->async_get_tilt(boost::asio::use_awaitable);
///
/// A completion has the signature void(std::exception_ptr) or void(std::exception_ptr, T). It runs
/// on the handler's associated executor, which has work to do until then; without one, on a thread
/// of the node, where it should not take long. The stub must live until the call has been started;
/// what is passed is copied or sent before that.
namespace rr {

/// Ends at a handler: keeps its executor busy until then, and calls it there.
template <class Handler>
class HandlerCompletion : public Completion {
 public:
  explicit HandlerCompletion(Handler handler)
      : work_(boost::asio::get_associated_executor(handler)), handler_(std::move(handler)) {}

 protected:
  template <class... Results>
  void finish(Results... results) {
    const auto executor = boost::asio::get_associated_executor(handler_);
    auto work = std::move(work_);
    boost::asio::dispatch(
        executor, [handler = std::move(handler_), ... values = std::move(results)]() mutable {
          std::move(handler)(std::move(values)...);
        });
    work.reset();
  }

 private:
  boost::asio::executor_work_guard<boost::asio::associated_executor_t<Handler>> work_;
  Handler handler_;
};

/// Of a call that returns an R.
template <class Handler, class R>
class CallCompletion final : public HandlerCompletion<Handler> {
 public:
  using HandlerCompletion<Handler>::HandlerCompletion;
  void* result() override { return &result_; }
  void succeed() override { this->finish(std::exception_ptr(), std::move(result_)); }
  void fail(std::exception_ptr error) override { this->finish(std::move(error), R()); }

 private:
  R result_{};
};

/// Of a call that returns nothing.
template <class Handler>
class CallCompletion<Handler, void> final : public HandlerCompletion<Handler> {
 public:
  using HandlerCompletion<Handler>::HandlerCompletion;
  void* result() override { return nullptr; }
  void succeed() override { this->finish(std::exception_ptr()); }
  void fail(std::exception_ptr error) override { this->finish(std::move(error)); }
};

/// Of the search for an object.
template <class Handler, class S>
class FindCompletion final : public HandlerCompletion<Handler> {
 public:
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

/// The signature of a completion.
template <class R>
struct CompletionSignature {
  using type = void(std::exception_ptr, R);
};
template <>
struct CompletionSignature<void> {
  using type = void(std::exception_ptr);
};

template <class R, class Token, class... Arguments>
auto Stub::rr_async_call(const Member& member, Token&& token, const Arguments&... arguments) {
  return boost::asio::async_initiate<Token, typename CompletionSignature<R>::type>(
      [this, call = &member](auto&& handler, const Arguments&... values) {
        using Handler = std::decay_t<decltype(handler)>;
        const void* const places[] = {&values..., nullptr};
        rr_start(
            *call, false, places,
            std::make_unique<CallCompletion<Handler, R>>(std::forward<decltype(handler)>(handler)));
      },
      token, arguments...);
}

template <class T, class Token>
auto Stub::rr_async_get(const Member& member, Token&& token) {
  return boost::asio::async_initiate<Token, void(std::exception_ptr, T)>(
      [this, property = &member](auto&& handler) {
        using Handler = std::decay_t<decltype(handler)>;
        rr_start(
            *property, false, nullptr,
            std::make_unique<CallCompletion<Handler, T>>(std::forward<decltype(handler)>(handler)));
      },
      token);
}

template <class T, class Token>
auto Stub::rr_async_set(const Member& member, Token&& token, const T& value) {
  return boost::asio::async_initiate<Token, void(std::exception_ptr)>(
      [this, property = &member](auto&& handler, const T& wanted) {
        using Handler = std::decay_t<decltype(handler)>;
        const void* const place = &wanted;
        rr_start(*property, true, &place,
                 std::make_unique<CallCompletion<Handler, void>>(
                     std::forward<decltype(handler)>(handler)));
      },
      token, value);
}

template <class S, class Token, class... Index>
auto Stub::rr_async_find(const Member& member, Token&& token, const Index&... index) {
  return boost::asio::async_initiate<Token, void(std::exception_ptr, std::shared_ptr<S>)>(
      [this, objref = &member](auto&& handler, const auto&... wanted) {
        using Handler = std::decay_t<decltype(handler)>;
        this->rr_start_find(*objref, wanted...,
                            std::make_unique<FindCompletion<Handler, S>>(
                                std::forward<decltype(handler)>(handler), *objref));
      },
      token, index...);
}

/// Connects as Node::connect does, on a thread of its own. Signature: void(std::exception_ptr,
/// Client<S>).
template <class S, class Token>
auto async_connect(Node& node, std::string url, Token&& token, ConnectOptions options = {}) {
  return boost::asio::async_initiate<Token, void(std::exception_ptr, Client<S>)>(
      [&node](auto&& handler, std::string place, ConnectOptions wishes) {
        using Handler = std::decay_t<decltype(handler)>;
        const auto completion = std::make_shared<CallCompletion<Handler, Client<S>>>(
            std::forward<decltype(handler)>(handler));
        node.connect_aside<S>(std::move(place), std::move(wishes),
                              [completion](std::exception_ptr error, Client<S> client) {
                                if (error) {
                                  completion->fail(std::move(error));
                                  return;
                                }
                                *static_cast<Client<S>*>(completion->result()) = std::move(client);
                                completion->succeed();
                              });
      },
      token, std::move(url), std::move(options));
}

}  // namespace rr
