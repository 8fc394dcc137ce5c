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
#include <chrono>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "rr/client.hpp"
#include "rr/generators.hpp"
#include "rr/memories.hpp"
#include "rr/node.hpp"
#include "rr/pipes.hpp"
#include "rr/skeleton.hpp"
#include "rr/stub.hpp"
#include "rr/subscription.hpp"
#include "rr/wires.hpp"

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
template <class Handler, class Base = Completion>
class HandlerCompletion : public Base {
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

/// Of a call that opens a generator.
template <class Handler, class R, class P>
class GeneratorCompletion final : public HandlerCompletion<Handler> {
 public:
  using HandlerCompletion<Handler>::HandlerCompletion;
  void* result() override { return &state_; }
  void succeed() override {
    this->finish(std::exception_ptr(), Generator<R, P>(std::move(state_)));
  }
  void fail(std::exception_ptr error) override {
    this->finish(std::move(error), Generator<R, P>());
  }

 private:
  std::shared_ptr<GeneratorState> state_;
};

/// Of a generator's step that gives an R.
template <class Handler, class R>
class StepCompletion final : public HandlerCompletion<Handler, GeneratorStep> {
 public:
  using HandlerCompletion<Handler, GeneratorStep>::HandlerCompletion;
  void* result() override { return &result_; }
  void succeed() override {
    this->finish(std::exception_ptr(), std::optional<R>(std::move(result_)));
  }
  void stop() override { this->finish(std::exception_ptr(), std::optional<R>()); }
  void fail(std::exception_ptr error) override {
    this->finish(std::move(error), std::optional<R>());
  }

 private:
  R result_{};
};

/// Of a step that gives nothing.
template <class Handler>
class StepCompletion<Handler, void> final : public HandlerCompletion<Handler, GeneratorStep> {
 public:
  using HandlerCompletion<Handler, GeneratorStep>::HandlerCompletion;
  void* result() override { return nullptr; }
  void succeed() override { this->finish(std::exception_ptr(), true); }
  void stop() override { this->finish(std::exception_ptr(), false); }
  void fail(std::exception_ptr error) override { this->finish(std::move(error), false); }
};

template <class R, class P, class Token, class... Arguments>
auto Stub::rr_async_generate(const Member& member, Token&& token, const Arguments&... arguments) {
  return boost::asio::async_initiate<Token, void(std::exception_ptr, Generator<R, P>)>(
      [this, call = &member](auto&& handler, const Arguments&... values) {
        using Handler = std::decay_t<decltype(handler)>;
        const void* const places[] = {&values..., nullptr};
        rr_start_generator(*call, places,
                           std::make_unique<GeneratorCompletion<Handler, R, P>>(
                               std::forward<decltype(handler)>(handler)));
      },
      token, arguments...);
}

template <class R, class P>
template <class Token>
auto Generator<R, P>::async_next(const P& parameter, Token&& token) {
  return boost::asio::async_initiate<Token, void(std::exception_ptr, std::optional<R>)>(
      [state = state_](auto&& handler, const P& value) {
        using Handler = std::decay_t<decltype(handler)>;
        start_step(
            state, &value,
            std::make_unique<StepCompletion<Handler, R>>(std::forward<decltype(handler)>(handler)));
      },
      token, parameter);
}

template <class P>
template <class Token>
auto Generator<void, P>::async_next(const P& parameter, Token&& token) {
  return boost::asio::async_initiate<Token, void(std::exception_ptr, bool)>(
      [state = state_](auto&& handler, const P& value) {
        using Handler = std::decay_t<decltype(handler)>;
        start_step(state, &value,
                   std::make_unique<StepCompletion<Handler, void>>(
                       std::forward<decltype(handler)>(handler)));
      },
      token, parameter);
}

template <class R>
template <class Token>
auto Generator<R, void>::async_next(Token&& token) {
  return boost::asio::async_initiate<Token, void(std::exception_ptr, std::optional<R>)>(
      [state = state_](auto&& handler) {
        using Handler = std::decay_t<decltype(handler)>;
        start_step(
            state, nullptr,
            std::make_unique<StepCompletion<Handler, R>>(std::forward<decltype(handler)>(handler)));
      },
      token);
}

template <class Token>
auto GeneratorHandle::async_end(Token&& token, bool aborts) {
  return boost::asio::async_initiate<Token, void(std::exception_ptr)>(
      [state = state_, aborts](auto&& handler) {
        using Handler = std::decay_t<decltype(handler)>;
        start_end(state, aborts,
                  std::make_unique<CallCompletion<Handler, void>>(
                      std::forward<decltype(handler)>(handler)));
      },
      token);
}

template <class R, class Token, class... Arguments>
auto Skeleton::rr_async_call_back(const Member& member, Token&& token, std::uint32_t client,
                                  const Arguments&... arguments) const {
  return boost::asio::async_initiate<Token, typename CompletionSignature<R>::type>(
      [this, callback = &member, client](auto&& handler, const Arguments&... values) {
        using Handler = std::decay_t<decltype(handler)>;
        const void* const places[] = {&values..., nullptr};
        rr_start_asking(
            *callback, client, places,
            std::make_unique<CallCompletion<Handler, R>>(std::forward<decltype(handler)>(handler)));
      },
      token, arguments...);
}

template <class T>
template <class Token>
auto ArrayMemory<T>::async_read(std::uint64_t position, std::uint64_t count, Token&& token) const {
  return boost::asio::async_initiate<Token, void(std::exception_ptr, Array<T>)>(
      [memory = *this, position, count](auto&& handler) {
        using Handler = std::decay_t<decltype(handler)>;
        auto completion = std::make_unique<CallCompletion<Handler, Array<T>>>(
            std::forward<decltype(handler)>(handler));
        auto& items = *static_cast<Array<T>*>(completion->result());
        items = Array<T>(size_of({&count, 1}));
        memory.start_read({&position, 1}, {&count, 1}, items.mutate().data(), items.size(),
                          std::move(completion));
      },
      token);
}

template <class T>
template <class Token>
auto ArrayMemory<T>::async_write(std::uint64_t position, const Array<T>& items,
                                 Token&& token) const {
  return boost::asio::async_initiate<Token, void(std::exception_ptr)>(
      [memory = *this, position](auto&& handler, const Array<T>& kept) {
        using Handler = std::decay_t<decltype(handler)>;
        const std::uint64_t count = kept.size();
        memory.start_write({&position, 1}, {&count, 1}, kept.data(), kept.size(), kept.owner(),
                           std::make_unique<CallCompletion<Handler, void>>(
                               std::forward<decltype(handler)>(handler)));
      },
      token, items.owner() ? items : Array<T>(std::span<const T>(items)));
}

template <class T>
template <class Token>
auto MultiMemory<T>::async_read(std::vector<std::uint64_t> position,
                                std::vector<std::uint64_t> count, Token&& token) const {
  return boost::asio::async_initiate<Token, void(std::exception_ptr, MultiArray<T>)>(
      [memory = *this](auto&& handler, const std::vector<std::uint64_t>& where,
                       const std::vector<std::uint64_t>& shape) {
        using Handler = std::decay_t<decltype(handler)>;
        auto completion = std::make_unique<CallCompletion<Handler, MultiArray<T>>>(
            std::forward<decltype(handler)>(handler));
        auto& array = *static_cast<MultiArray<T>*>(completion->result());
        array = {{shape.begin(), shape.end()}, Array<T>(size_of(shape))};
        memory.start_read(where, shape, array.items.mutate().data(), array.items.size(),
                          std::move(completion));
      },
      token, std::move(position), std::move(count));
}

template <class T>
template <class Token>
auto MultiMemory<T>::async_write(std::vector<std::uint64_t> position, const MultiArray<T>& array,
                                 Token&& token) const {
  return boost::asio::async_initiate<Token, void(std::exception_ptr)>(
      [memory = *this](auto&& handler, const std::vector<std::uint64_t>& where,
                       const std::vector<std::uint64_t>& shape, const Array<T>& kept) {
        using Handler = std::decay_t<decltype(handler)>;
        memory.start_write(where, shape, kept.data(), kept.size(), kept.owner(),
                           std::make_unique<CallCompletion<Handler, void>>(
                               std::forward<decltype(handler)>(handler)));
      },
      token, std::move(position), std::vector<std::uint64_t>(array.dims.begin(), array.dims.end()),
      array.items.owner() ? array.items : Array<T>(std::span<const T>(array.items)));
}

template <class T>
template <class Token>
auto Wire<T>::async_connect(Token&& token) {
  return boost::asio::async_initiate<Token, void(std::exception_ptr, WireConnection<T>)>(
      [wire = *this](auto&& handler) mutable {
        using Handler = std::decay_t<decltype(handler)>;
        auto completion = std::make_unique<CallCompletion<Handler, WireConnection<T>>>(
            std::forward<decltype(handler)>(handler));
        auto* const end = static_cast<WireConnection<T>*>(completion->result());
        wire.start_connect(end, std::move(completion));
      },
      token);
}

template <class T>
template <class Token>
auto Wire<T>::async_peek(bool of_out, Token&& token) {
  return boost::asio::async_initiate<Token, void(std::exception_ptr, Timed<T>)>(
      [wire = *this, of_out](auto&& handler) mutable {
        using Handler = std::decay_t<decltype(handler)>;
        auto completion = std::make_unique<CallCompletion<Handler, Timed<T>>>(
            std::forward<decltype(handler)>(handler));
        auto* const place = static_cast<Timed<T>*>(completion->result());
        wire.start_peek(of_out, &place->value, &place->time, std::move(completion));
      },
      token);
}

template <class T>
template <class Token>
auto Wire<T>::async_peek_in(Token&& token) {
  return async_peek(false, std::forward<Token>(token));
}

template <class T>
template <class Token>
auto Wire<T>::async_peek_out(Token&& token) {
  return async_peek(true, std::forward<Token>(token));
}

template <class T>
template <class Token>
auto Wire<T>::async_poke_out(const T& value, Token&& token) {
  return boost::asio::async_initiate<Token, void(std::exception_ptr)>(
      [wire = *this](auto&& handler, const T& wanted) mutable {
        using Handler = std::decay_t<decltype(handler)>;
        wire.start_poke(&wanted, std::make_unique<CallCompletion<Handler, void>>(
                                     std::forward<decltype(handler)>(handler)));
      },
      token, value);
}

/// Of a packet that is waited for.
template <class Handler, class T>
class PacketCompletion final : public HandlerCompletion<Handler> {
 public:
  using HandlerCompletion<Handler>::HandlerCompletion;
  void* result() override { return &packet_; }
  void succeed() override {
    this->finish(std::exception_ptr(), std::move(*static_cast<T*>(packet_.get())));
  }
  void fail(std::exception_ptr error) override { this->finish(std::move(error), T{}); }

 private:
  std::shared_ptr<void> packet_;
};

template <class T>
template <class Token>
auto PipeEndpoint<T>::async_receive(Token&& token) {
  return boost::asio::async_initiate<Token, void(std::exception_ptr, T)>(
      [end = *this](auto&& handler) mutable {
        using Handler = std::decay_t<decltype(handler)>;
        end.start_receive(std::make_unique<PacketCompletion<Handler, T>>(
            std::forward<decltype(handler)>(handler)));
      },
      token);
}

/// Of an endpoint of a pipe.
template <class Handler, class T>
class PipeCompletion final : public HandlerCompletion<Handler> {
 public:
  using HandlerCompletion<Handler>::HandlerCompletion;
  void* result() override { return &end_; }
  void succeed() override { this->finish(std::exception_ptr(), PipeEndpoint<T>(std::move(end_))); }
  void fail(std::exception_ptr error) override {
    this->finish(std::move(error), PipeEndpoint<T>());
  }

 private:
  PipeEnd end_;
};

template <class T>
template <class Token>
auto Pipe<T>::async_connect(Token&& token, const PipeOptions& options) {
  return boost::asio::async_initiate<Token, void(std::exception_ptr, PipeEndpoint<T>)>(
      [pipe = *this](auto&& handler, const PipeOptions& wishes) mutable {
        using Handler = std::decay_t<decltype(handler)>;
        pipe.start_connect(wishes, std::make_unique<PipeCompletion<Handler, T>>(
                                       std::forward<decltype(handler)>(handler)));
      },
      token, options);
}

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
