// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/bind_executor.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/use_future.hpp>
#include <chrono>
#include <condition_variable>
#include <future>
#include <mutex>
#include <thread>

#include "rr/call.hpp"
#include "runtime/cpp/src/node/testing/async_counter.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::testing {

namespace {

using boost::asio::use_awaitable;
using boost::asio::use_future;

TEST(Async, AFutureGetsTheResult) {
  Pair pair;
  auto counter = pair.connect();
  counter->async_set_value(3.5, use_future).get();
  EXPECT_EQ(counter->async_get_value(use_future).get(), 3.5);
  EXPECT_EQ(counter->async_add(1, 2, use_future).get(), 3);
}

TEST(Async, AFutureGetsTheError) {
  Pair pair;
  auto counter = pair.connect();
  auto known = counter->async_raise(0, "too far", use_future);
  EXPECT_THROW(known.get(), Overrun);
  auto coded = counter->async_raise(29, "out", use_future);
  EXPECT_EQ(error_of([&] { coded.get(); }).code(), ErrorCode::out_of_range);
}

TEST(Async, ACallbackWithoutAnExecutorRunsOnAThreadOfTheNode) {
  std::promise<std::pair<double, std::thread::id>> promise;
  Pair pair;
  auto counter = pair.connect();
  counter->async_add(1, 2, [&](const std::exception_ptr& error, double sum) {
    EXPECT_FALSE(error);
    promise.set_value({sum, std::this_thread::get_id()});
  });
  const auto [sum, thread] = promise.get_future().get();
  EXPECT_EQ(sum, 3);
  EXPECT_NE(thread, std::this_thread::get_id());
}

TEST(Async, ACallbackRunsOnItsExecutorWhichHasWorkUntilThen) {
  Pair pair;
  auto counter = pair.connect();
  boost::asio::io_context context;
  double sum = 0;
  std::thread::id thread;
  counter->async_add(1, 2, boost::asio::bind_executor(context, [&](std::exception_ptr, double s) {
                       sum = s;
                       thread = std::this_thread::get_id();
                     }));
  context.run();  // returns when the handler has run, not before
  EXPECT_EQ(sum, 3);
  EXPECT_EQ(thread, std::this_thread::get_id());
}

boost::asio::awaitable<double> add_twice(CounterStub& counter) {
  const double sum = co_await counter.async_add(1, 2, use_awaitable);
  co_await counter.async_set_value(sum, use_awaitable);
  const auto other = co_await counter.async_get_by_name("left", use_awaitable);
  co_return co_await other->async_add(co_await counter.async_get_value(use_awaitable), 10,
                                      use_awaitable);
}

TEST(Async, CoroutinesAwaitCalls) {
  Pair pair;
  auto counter = pair.connect();
  boost::asio::io_context context;
  auto result = boost::asio::co_spawn(context, add_twice(*counter), use_future);
  context.run();
  EXPECT_EQ(result.get(), 13);
}

TEST(Async, ManyCallsMayBeOpenAtOnce) {
  Pair pair;
  auto counter = pair.connect();
  std::vector<std::future<double>> sums;
  sums.reserve(1000);
  for (int i = 0; i < 1000; ++i) sums.push_back(counter->async_add(i, 1, use_future));
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(sums[static_cast<std::size_t>(i)].get(), i + 1);
}

TEST(Async, CallsOfOneClientAreHandledInTheOrderOfTheirStart) {
  class OrderedCounter : public Counter {
   public:
    double add(double a, double b) override {
      EXPECT_EQ(running.fetch_add(1), 0);
      EXPECT_EQ(a, next.fetch_add(1));
      running.fetch_sub(1);
      return a + b;
    }
    std::atomic<int> running{0};
    std::atomic<int> next{0};
  };
  const auto object = std::make_shared<OrderedCounter>();
  Pair pair({}, {}, object);
  auto counter = pair.connect();
  std::vector<std::future<double>> sums;
  for (int i = 0; i < 2000; ++i) {
    if (i % 100 == 99) {  // a blocking call comes behind those that were started before
      EXPECT_EQ(counter->add(i, 0), i);
    } else {
      sums.push_back(counter->async_add(i, 0, use_future));
    }
  }
  for (auto& sum : sums) sum.get();
  EXPECT_EQ(object->next, 2000);
}

TEST(Async, ACallWithoutAnAnswerInTimeFails) {
  Pair pair;
  auto counter = pair.connect();
  const auto before = std::chrono::steady_clock::now();
  auto call = counter->async_slow(1000, within(std::chrono::milliseconds(50)), use_future);
  EXPECT_EQ(error_of([&] { call.get(); }).code(), ErrorCode::request_timeout);
  EXPECT_LT(std::chrono::steady_clock::now() - before, std::chrono::milliseconds(900));
}

TEST(Async, ACancelledCallFails) {
  Pair pair;
  auto counter = pair.connect();
  std::stop_source stop;
  auto call = counter->async_slow(500, stopped_by(stop.get_token()), use_future);
  auto other = counter->async_add(1, 2, use_future);
  stop.request_stop();
  EXPECT_EQ(error_of([&] { call.get(); }).code(), ErrorCode::operation_cancelled);
  EXPECT_EQ(other.get(), 3);
}

TEST(Async, OpenCallsFailWhenTheClientIsClosed) {
  Pair pair;
  auto counter = pair.connect();
  const auto stub = counter.stub();
  auto call = stub->async_slow(900, use_future);
  counter.close();
  EXPECT_EQ(error_of([&] { call.get(); }).code(), ErrorCode::connection_error);
  auto late = stub->async_add(1, 2, use_future);
  EXPECT_NE(error_of([&] { late.get(); }).code(), ErrorCode::none);
}

TEST(Async, ACompletionMayMakeBlockingCalls) {
  std::promise<double> promise;
  Pair pair;
  auto counter = pair.connect();
  counter->async_add(
      1, 2, [&](std::exception_ptr, double sum) { promise.set_value(counter->add(sum, 4)); });
  EXPECT_EQ(promise.get_future().get(), 7);
}

TEST(Async, ConnectsWithAnyToken) {
  Pair pair;
  auto counter = async_connect<CounterStub>(pair.client, pair.url(), use_future).get();
  EXPECT_EQ(counter->get_fixed(), 42.125);
  auto nobody = async_connect<CounterStub>(pair.client, pair.url("nobody"), use_future);
  EXPECT_EQ(error_of([&] { nobody.get(); }).code(), ErrorCode::service_not_found);
  auto plain = pair.client.async_connect<CounterStub>(pair.url()).get();
  EXPECT_EQ(plain->get_fixed(), 42.125);
}

}  // namespace
}  // namespace rr::testing
