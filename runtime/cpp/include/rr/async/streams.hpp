// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <memory>
#include <type_traits>
#include <utility>

#include "rr/async/completion.hpp"
#include "rr/pipes.hpp"
#include "rr/visibility.hpp"
#include "rr/wires.hpp"

/// Wires and pipes; see rr/async.hpp.
namespace RR_VISIBLE rr {

template <class T>
template <class Token>
auto Wire<T>::async_connect(const CallOptions& options, Token&& token) {
  return boost::asio::async_initiate<Token, void(std::exception_ptr, WireConnection<T>)>(
      [wire = *this, options](auto&& handler) mutable {
        using Handler = std::decay_t<decltype(handler)>;
        auto completion = std::make_unique<CallCompletion<Handler, WireConnection<T>>>(
            std::forward<decltype(handler)>(handler));
        auto* const end = static_cast<WireConnection<T>*>(completion->result());
        start_call(std::move(completion), options,
                   [&](auto ending) { wire.start_connect(end, std::move(ending)); });
      },
      token);
}

template <class T>
template <class Token>
auto Wire<T>::async_peek(bool of_out, const CallOptions& options, Token&& token) {
  return boost::asio::async_initiate<Token, void(std::exception_ptr, Timed<T>)>(
      [wire = *this, of_out, options](auto&& handler) mutable {
        using Handler = std::decay_t<decltype(handler)>;
        auto completion = std::make_unique<CallCompletion<Handler, Timed<T>>>(
            std::forward<decltype(handler)>(handler));
        auto* const place = static_cast<Timed<T>*>(completion->result());
        start_call(std::move(completion), options, [&](auto ending) {
          wire.start_peek(of_out, &place->value, &place->time, std::move(ending));
        });
      },
      token);
}

template <class T>
template <class Token>
auto Wire<T>::async_poke_out(const T& value, const CallOptions& options, Token&& token) {
  return boost::asio::async_initiate<Token, void(std::exception_ptr)>(
      [wire = *this, options](auto&& handler, const T& wanted) mutable {
        using Handler = std::decay_t<decltype(handler)>;
        start_call(std::make_unique<CallCompletion<Handler, void>>(
                       std::forward<decltype(handler)>(handler)),
                   options,
                   [&](auto completion) { wire.start_poke(&wanted, std::move(completion)); });
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
auto PipeEndpoint<T>::async_receive(const CallOptions& options, Token&& token) {
  return boost::asio::async_initiate<Token, void(std::exception_ptr, T)>(
      [end = *this, options](auto&& handler) mutable {
        using Handler = std::decay_t<decltype(handler)>;
        start_call(std::make_unique<PacketCompletion<Handler, T>>(
                       std::forward<decltype(handler)>(handler)),
                   options, [&](auto completion) { end.start_receive(std::move(completion)); });
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
auto Pipe<T>::async_connect(const PipeOptions& wishes, const CallOptions& options, Token&& token) {
  return boost::asio::async_initiate<Token, void(std::exception_ptr, PipeEndpoint<T>)>(
      [pipe = *this, wishes, options](auto&& handler) mutable {
        using Handler = std::decay_t<decltype(handler)>;
        start_call(
            std::make_unique<PipeCompletion<Handler, T>>(std::forward<decltype(handler)>(handler)),
            options, [&](auto completion) { pipe.start_connect(wishes, std::move(completion)); });
      },
      token);
}

}  // namespace rr
