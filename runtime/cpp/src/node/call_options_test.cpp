// SPDX-License-Identifier: Apache-2.0
// Time-outs and stops that are given with a call.
#include <gtest/gtest.h>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/use_future.hpp>
#include <chrono>
#include <future>
#include <stop_token>
#include <thread>

#include "rr/call.hpp"
#include "runtime/cpp/src/node/testing/async_counter.hpp"
#include "runtime/cpp/src/node/testing/keeping_counter.hpp"

namespace rr::testing {
namespace {

using boost::asio::awaitable;
using boost::asio::use_awaitable;
using boost::asio::use_future;
using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;

// NOLINTNEXTLINE(performance-unnecessary-value-param): a coroutine outlives its arguments
awaitable<ErrorCode> outcome_of_slow(CounterStub& counter, CallOptions options) {
  try {
    co_await counter.async_slow(0, options, use_awaitable);
  } catch (const Error& error) {
    co_return error.code();
  }
  co_return ErrorCode::none;
}

TEST(CallOptions, OfOneCoroutineDoNotEndTheCallOfAnother) {
  KeepingPair pair;
  boost::asio::io_context context;
  const auto impatient = [&]() -> awaitable<void> {
    EXPECT_EQ(co_await outcome_of_slow(*pair.counter, within(60ms)), ErrorCode::request_timeout);
    pair.object->answer_all();
  };
  boost::asio::co_spawn(context, impatient(), boost::asio::detached);
  auto patient =
      boost::asio::co_spawn(context, outcome_of_slow(*pair.counter, {}), boost::asio::use_future);
  context.run();
  EXPECT_EQ(patient.get(), ErrorCode::none);
}

TEST(CallOptions, OfBlockingCallsAreNotThoseOfAsynchronousOnes) {
  KeepingPair pair;
  std::stop_source stop;
  std::future<void> call = with_options(within(1ms, stop.get_token()),
                                        [&] { return pair.counter->async_slow(0, use_future); });
  EXPECT_TRUE(eventually([&] { return pair.object->kept() == 1; }));
  stop.request_stop();
  EXPECT_EQ(call.wait_for(50ms), std::future_status::timeout);
  pair.object->answer_all();
  call.get();
}

template <class Function>
concept TakenByWithOptions = requires(Function function) {
  with_options(within(1s), std::move(function));
};

TEST(CallOptions, RefuseACoroutineWhichMightGoOnElsewhere) {
  const auto coroutine = []() -> awaitable<int> { co_return 1; };
  const auto function = [] { return 1; };
  EXPECT_FALSE(TakenByWithOptions<decltype(coroutine)>);
  EXPECT_TRUE(TakenByWithOptions<decltype(function)>);
  EXPECT_EQ(with_options(within(1s), function), 1);
}

TEST(CallOptions, ACallThatIsStoppedBeforehandIsNotSent) {
  KeepingPair pair;
  std::stop_source stop;
  stop.request_stop();
  const CallOptions stopped = stopped_by(stop.get_token());
  EXPECT_EQ(error_of([&] { with_options(stopped, [&] { pair.counter->slow(0); }); }).code(),
            ErrorCode::operation_cancelled);
  auto call = pair.counter->async_slow(0, stopped, use_future);
  EXPECT_EQ(error_of([&] { call.get(); }).code(), ErrorCode::operation_cancelled);
  EXPECT_EQ(pair.counter->add(1, 2), 3);  // by now a request would have come
  EXPECT_EQ(pair.object->kept(), 0U);
}

TEST(CallOptions, TakeTheStopOfAThread) {
  KeepingPair pair;
  std::promise<ErrorCode> code;
  std::jthread caller([&](const std::stop_token& stop) {
    code.set_value(
        error_of([&] { with_options(stopped_by(stop), [&] { pair.counter->slow(0); }); }).code());
  });
  EXPECT_TRUE(eventually([&] { return pair.object->kept() == 1; }));
  caller.request_stop();
  EXPECT_EQ(code.get_future().get(), ErrorCode::operation_cancelled);
  EXPECT_EQ(pair.counter->add(1, 2), 3);
}

bool is_answered_or_stopped(ErrorCode code) {
  return code == ErrorCode::none || code == ErrorCode::operation_cancelled;
}

// A stop may come at any instant of a call: before it is open, while its answer is read, behind it.
TEST(CallOptions, AStopAtAnyInstantEndsTheCallOnce) {
  Pair pair;
  auto counter = pair.connect();
  constexpr int rounds = 500;
  for (int i = 0; i < rounds; ++i) {
    std::stop_source stop;
    const CallOptions options = stopped_by(stop.get_token());
    std::jthread stopper([&] {
      std::this_thread::sleep_for(std::chrono::microseconds(i % 100));
      stop.request_stop();
    });
    auto call = counter->async_add(1, i, options, use_future);
    const Error blocking =
        error_of([&] { with_options(options, [&] { EXPECT_EQ(counter->add(1, i), 1 + i); }); });
    EXPECT_TRUE(is_answered_or_stopped(blocking.code())) << blocking.what();
    const Error started = error_of([&] { EXPECT_EQ(call.get(), 1 + i); });
    EXPECT_TRUE(is_answered_or_stopped(started.code())) << started.what();
  }
  EXPECT_EQ(counter->add(1, 2), 3);
}

}  // namespace
}  // namespace rr::testing
