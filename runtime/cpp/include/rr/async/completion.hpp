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

#include "rr/stub.hpp"

/// What the asynchronous forms of rr/async.hpp end with.
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

/// The signature of a completion.
template <class R>
struct CompletionSignature {
  using type = void(std::exception_ptr, R);
};
template <>
struct CompletionSignature<void> {
  using type = void(std::exception_ptr);
};

}  // namespace rr
