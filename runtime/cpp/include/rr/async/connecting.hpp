// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <exception>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include "rr/async/completion.hpp"
#include "rr/client.hpp"
#include "rr/node.hpp"
#include "rr/subscription.hpp"
#include "rr/visibility.hpp"

/// Clients, and those of subscriptions; see rr/async.hpp.
namespace RR_VISIBLE rr {

/// Of a stub that is waited for.
template <class Handler, class S>
class StubCompletion final : public HandlerCompletion<Handler> {
 public:
  using HandlerCompletion<Handler>::HandlerCompletion;
  void* result() override { return &found_; }
  void succeed() override {
    std::shared_ptr<S> stub;
    try {
      stub = stub_cast<S>(std::move(found_));
    } catch (...) {
      fail(std::current_exception());
      return;
    }
    this->finish(std::exception_ptr(), std::move(stub));
  }
  void fail(std::exception_ptr error) override {
    this->finish(std::move(error), std::shared_ptr<S>());
  }

 private:
  std::shared_ptr<Stub> found_;
};

/// For the subscriptions that have a default client: hands `start` what completes the token.
template <class S, class Start, class Token>
auto initiate_wait(Start start, Token&& token) {
  return boost::asio::async_initiate<Token, void(std::exception_ptr, std::shared_ptr<S>)>(
      [start = std::move(start)](auto&& handler) {
        using Handler = std::decay_t<decltype(handler)>;
        start(
            std::make_unique<StubCompletion<Handler, S>>(std::forward<decltype(handler)>(handler)));
      },
      token);
}

template <class S, class Token>
auto ServiceSubscription::async_default_client(std::chrono::milliseconds limit,
                                               Token&& token) const {
  return initiate_wait<S>(
      [subscription = *this, limit](std::unique_ptr<Completion> completion) {
        subscription.start_wait(type_of_stub<S>(), limit, std::move(completion));
      },
      std::forward<Token>(token));
}

template <class S, class Token>
auto SubObjectSubscription::async_default_client(std::chrono::milliseconds limit,
                                                 Token&& token) const {
  return initiate_wait<S>(
      [subscription = *this, limit](std::unique_ptr<Completion> completion) {
        subscription.start_wait(type_of_stub<S>(), limit, std::move(completion));
      },
      std::forward<Token>(token));
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
