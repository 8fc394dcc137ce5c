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
#include <boost/asio/system_executor.hpp>
#include <boost/version.hpp>
#include <exception>
#include <memory>
#include <type_traits>

#include "rr/call.hpp"
#include "rr/stub.hpp"
#include "rr/visibility.hpp"

#if BOOST_VERSION >= 107700
#include <boost/asio/associated_cancellation_slot.hpp>
#include <optional>
#include <stop_token>
#endif

/// What the asynchronous forms of rr/async.hpp end with.
namespace RR_VISIBLE rr {

#if BOOST_VERSION >= 107700
/// Ends a call when the cancellation slot of its handler says so, or another stop is requested.
class SlotStop {
 public:
  /// Listens to `slot`, and to `other`. Only terminal cancellation counts.
  SlotStop(boost::asio::cancellation_slot slot, const std::stop_token& other)
      : other_(other, Request{stop_}) {
    slot.assign([stop = stop_](boost::asio::cancellation_type kind) mutable {
      // What has been sent cannot be taken back, so that gentler kinds cannot be had.
      const auto terminal = kind & boost::asio::cancellation_type::terminal;
      if (terminal != boost::asio::cancellation_type::none) stop.request_stop();
    });
  }
  /// Is stopped when either of them says so.
  [[nodiscard]] std::stop_token token() const { return stop_.get_token(); }

 private:
  struct Request {
    std::stop_source stop;
    void operator()() { stop.request_stop(); }
  };
  std::stop_source stop_;
  std::stop_callback<Request> other_;
};
#endif

/// Ends at a handler: keeps its executor busy until then, and calls it there.
template <class Handler, class Base = Completion>
class HandlerCompletion : public Base {
 public:
  /// Keeps the executor of `handler` busy until finish().
  explicit HandlerCompletion(Handler handler)
      : work_(boost::asio::get_associated_executor(handler)), handler_(std::move(handler)) {}

  /// What the call is to be made with: `options`, and the handler's cancellation slot where Boost
  /// has these (1.77). Once.
  CallOptions terms(const CallOptions& options) {
#if BOOST_VERSION >= 107700
    const auto slot = boost::asio::get_associated_cancellation_slot(handler_);
    if (slot.is_connected()) {
      slot_stop_.emplace(slot, options.stop);
      return {options.timeout, slot_stop_->token()};
    }
#endif
    return options;
  }

 protected:
  /// Calls the handler with these on its executor; without one, on this thread.
  template <class... Results>
  void finish(Results... results) {
    const auto executor = boost::asio::get_associated_executor(handler_);
    using Executor = std::remove_const_t<decltype(executor)>;
    auto work = std::move(work_);
    if constexpr (std::is_same_v<Executor, boost::asio::system_executor>) {
      // Where no executor is associated: as this would, but that it ends the program when the
      // handler throws.
      Handler handler = std::move(handler_);
      std::move(handler)(std::move(results)...);
    } else {
      boost::asio::dispatch(
          executor, [handler = std::move(handler_), ... values = std::move(results)]() mutable {
            std::move(handler)(std::move(values)...);
          });
    }
    work.reset();
  }

 private:
  boost::asio::executor_work_guard<boost::asio::associated_executor_t<Handler>> work_;
  Handler handler_;
#if BOOST_VERSION >= 107700
  std::optional<SlotStop> slot_stop_;
#endif
};

/// Has `start` begin what ends with `completion`.
template <class Ending, class Start>
void start_call(std::unique_ptr<Ending> completion, const CallOptions& options,
                const Start& start) {
  const CallOptions terms = completion->terms(options);
  const CallOptionsScope scope(terms);
  start(std::move(completion));
}

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

/// The signature of a completion.
template <class R>
struct CompletionSignature {
  /// The error, null in success, and the result, default-constructed in failure.
  using type = void(std::exception_ptr, R);
};
/// The signature of a completion that brings no result.
template <>
struct CompletionSignature<void> {
  /// The error, null in success.
  using type = void(std::exception_ptr);
};

}  // namespace rr
