// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

#include "rr/async/completion.hpp"
#include "rr/generators.hpp"
#include "rr/stub.hpp"
#include "rr/visibility.hpp"

/// Generators; see rr/async.hpp.
namespace RR_VISIBLE rr {

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
requires AsyncHeaderIsIncluded<Token>
auto Stub::rr_async_generate(const Member& member, const CallOptions& options, Token&& token,
                             const Arguments&... arguments) {
  return boost::asio::async_initiate<Token, void(std::exception_ptr, Generator<R, P>)>(
      [this, call = &member, options](auto&& handler, const Arguments&... values) {
        using Handler = std::decay_t<decltype(handler)>;
        const void* const places[] = {&values..., nullptr};
        start_call(std::make_unique<GeneratorCompletion<Handler, R, P>>(
                       std::forward<decltype(handler)>(handler)),
                   options, [&](auto completion) {
                     rr_start_generator(*call, places, std::move(completion));
                   });
      },
      token, arguments...);
}

template <class R, class P>
template <class Token>
auto Generator<R, P>::async_next(const P& parameter, const CallOptions& options, Token&& token) {
  return boost::asio::async_initiate<Token, void(std::exception_ptr, std::optional<R>)>(
      [state = state_, options](auto&& handler, const P& value) {
        using Handler = std::decay_t<decltype(handler)>;
        start_call(
            std::make_unique<StepCompletion<Handler, R>>(std::forward<decltype(handler)>(handler)),
            options, [&](auto step) { start_step(state, &value, std::move(step)); });
      },
      token, parameter);
}

template <class P>
template <class Token>
auto Generator<void, P>::async_next(const P& parameter, const CallOptions& options, Token&& token) {
  return boost::asio::async_initiate<Token, void(std::exception_ptr, bool)>(
      [state = state_, options](auto&& handler, const P& value) {
        using Handler = std::decay_t<decltype(handler)>;
        start_call(std::make_unique<StepCompletion<Handler, void>>(
                       std::forward<decltype(handler)>(handler)),
                   options, [&](auto step) { start_step(state, &value, std::move(step)); });
      },
      token, parameter);
}

template <class R>
template <class Token>
auto Generator<R, void>::async_next(const CallOptions& options, Token&& token) {
  return boost::asio::async_initiate<Token, void(std::exception_ptr, std::optional<R>)>(
      [state = state_, options](auto&& handler) {
        using Handler = std::decay_t<decltype(handler)>;
        start_call(
            std::make_unique<StepCompletion<Handler, R>>(std::forward<decltype(handler)>(handler)),
            options, [&](auto step) { start_step(state, nullptr, std::move(step)); });
      },
      token);
}

template <class Token>
auto GeneratorHandle::async_end(bool aborts, const CallOptions& options, Token&& token) {
  return boost::asio::async_initiate<Token, void(std::exception_ptr)>(
      [state = state_, aborts, options](auto&& handler) {
        using Handler = std::decay_t<decltype(handler)>;
        start_call(std::make_unique<CallCompletion<Handler, void>>(
                       std::forward<decltype(handler)>(handler)),
                   options,
                   [&](auto completion) { start_end(state, aborts, std::move(completion)); });
      },
      token);
}

}  // namespace rr
