// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <memory>
#include <type_traits>
#include <utility>

#include "rr/async/completion.hpp"
#include "rr/pipes.hpp"
#include "rr/wires.hpp"

/// Wires and pipes; see rr/async.hpp.
namespace rr {

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

}  // namespace rr
