// SPDX-License-Identifier: Apache-2.0
// Properties and functions between two nodes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <boost/asio/use_future.hpp>
#include <chrono>
#include <future>
#include <string>
#include <thread>
#include <vector>

#include "rr/call.hpp"
#include "runtime/cpp/src/node/testing/async_counter.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""ms;
using Clock = std::chrono::steady_clock;

// Both formats, and the compact one with string tables.
struct Format {
  const char* name;
  Offer offer;
};
class CallsInFormat : public ::testing::TestWithParam<Format> {
 protected:
  static NodeOptions options() {
    return {.client_offer = GetParam().offer, .server_offer = GetParam().offer};
  }
  Pair pair{options(), options()};
};
INSTANTIATE_TEST_SUITE_P(
    Calls, CallsInFormat,
    ::testing::Values(Format{"v2", {.message_v4 = false}}, Format{"v4", {.string_table = false}},
                      Format{"v4st", {}},
                      Format{"v2_in_steps", {.message_v4 = false, .combined_connect = false}},
                      Format{"v4_in_steps", {.string_table = false, .combined_connect = false}}),
    [](const auto& test) { return std::string(test.param.name); });

TEST_P(CallsInFormat, APropertyIsSetAndGot) {
  auto counter = pair.connect();
  counter->set_value(2.5);
  EXPECT_EQ(counter->get_value(), 2.5);
  EXPECT_EQ(pair.object->get_value(), 2.5);
  EXPECT_EQ(counter->get_name(), "root");
}

TEST_P(CallsInFormat, AFunctionGetsItsArgumentsAndReturns) {
  auto counter = pair.connect();
  EXPECT_EQ(counter->add(1.25, 2.5), 3.75);
  EXPECT_EQ(counter->echo("h\xc3\xa9"), "h\xc3\xa9");
  EXPECT_EQ(counter->echo(""), "");
  counter->set_value(7);
  counter->reset();
  EXPECT_EQ(counter->get_value(), 0);
}

TEST_P(CallsInFormat, AStructComesBackOrIsNull) {
  auto counter = pair.connect();
  counter->set_value(4);
  const Reading expected{4, "north", {1, 2, 3}};
  EXPECT_EQ(counter->read("north"), expected);
  EXPECT_EQ(counter->read(""), std::nullopt);
}

TEST_P(CallsInFormat, AVarvalueKeepsItsType) {
  auto counter = pair.connect();
  EXPECT_EQ(counter->any(Array<double>{1, 2}), VarValue(Array<double>{1, 2}));
  EXPECT_EQ(counter->any("text"), VarValue("text"));
  EXPECT_TRUE(counter->any(VarValue()).is_null());
  EXPECT_EQ(counter->any(Reading{1, "x", {}}).get<Reading>(), (Reading{1, "x", {}}));
}

TEST_P(CallsInFormat, ErrorsArriveWithCodeNameAndData) {
  auto counter = pair.connect();
  const Error coded = error_of([&] { counter->raise(29, "too far"); });
  EXPECT_EQ(coded.code(), ErrorCode::out_of_range);
  EXPECT_EQ(coded.name(), "RobotRaconteur.OutOfRange");
  EXPECT_EQ(coded.message(), "too far");
  try {
    counter->raise(0, "over");
    ADD_FAILURE() << "nothing was thrown";
  } catch (const Overrun& overrun) {
    EXPECT_EQ(overrun.message(), "over");
    EXPECT_EQ(overrun.subname(), "deep");
    EXPECT_EQ(overrun.parameter(), VarValue(Array<double>{0.5, -0.25}));
  }
  const Error foreign = error_of([&] { counter->raise(-1, "plain"); });
  EXPECT_EQ(foreign.code(), ErrorCode::remote_error);
  EXPECT_EQ(foreign.name(), "std.exception");
  EXPECT_EQ(foreign.message(), "plain");
  EXPECT_EQ(counter->add(1, 1), 2);
}

TEST_P(CallsInFormat, LargeArraysArriveWhole) {
  auto counter = pair.connect();
  for (const std::uint32_t size : {0U, 1U, 15'000U, 70'000U, 1'000'000U, 10'000'000U}) {
    const Array<std::uint8_t> blob = counter->blob(size);
    ASSERT_EQ(blob.size(), size);
    for (std::size_t i = 0; i < size; i += 997) {
      ASSERT_EQ(blob[i], static_cast<std::uint8_t>(i * 31 + 7)) << i << " of " << size;
    }
  }
  EXPECT_EQ(counter->take(Array<double>(std::size_t{1'000'000})), 1'000'000U);
}

TEST(Calls, LargeArraysAreSlicesOfTheReceivedMessage) {
  Pair pair;
  auto counter = pair.connect();
  const Array<std::uint8_t> blob = counter->blob(1'000'000);
  EXPECT_TRUE(blob.owner());
  // In one process the sender may still be about to let go of it.
  EXPECT_TRUE(eventually([&] { return blob.owner().is_unique(); }));
}

TEST(Calls, WhatMayNotBeReadOrWrittenIsRefused) {
  Pair pair;
  auto counter = pair.connect();
  counter->set_hidden(3);
  EXPECT_EQ(pair.object->get_value(), 3);
  EXPECT_EQ(counter->get_fixed(), 42.125);
}

TEST(Calls, AMessageOverTheLimitIsRefusedBeforeItIsSent) {
  Pair pair({}, {.limits = {.message_size = 100'000}});
  auto counter = pair.connect();
  EXPECT_EQ(error_of([&] { counter->take(Array<double>(std::size_t{20'000})); }).code(),
            ErrorCode::protocol_error);
  EXPECT_EQ(counter->add(1, 2), 3);
}

TEST(Calls, AnAnswerOverTheLimitBecomesAnError) {
  Pair pair({.limits = {.message_size = 100'000}});
  auto counter = pair.connect();
  EXPECT_EQ(error_of([&] { counter->blob(200'000); }).code(), ErrorCode::protocol_error);
  EXPECT_EQ(counter->add(1, 2), 3);
}

TEST(Calls, ManyThreadsShareOneClient) {
  Pair pair;
  auto counter = pair.connect();
  std::atomic<int> wrong{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < 300; ++i) {
        if (counter->add(t, i) != t + i) ++wrong;
        if (i % 50 == 0 && counter->blob(100'000).size() != 100'000) ++wrong;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
}

TEST(Calls, ManyClientsShareOneService) {
  Pair pair;
  std::atomic<int> wrong{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 6; ++t) {
    threads.emplace_back([&, t] {
      for (int round = 0; round < 5; ++round) {
        auto counter = pair.connect();
        for (int i = 0; i < 40; ++i) {
          if (counter->add(t, i) != t + i) ++wrong;
        }
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_TRUE(eventually([&] { return pair.service->clients().empty(); }));
}

// Handlers that wait for the test.
class SlowCounter : public Counter {
 public:
  void slow(Reply<void> reply, std::int32_t milliseconds) override {
    if (milliseconds >= 0) {
      entered.set_value();
      gate.get_future().wait();
    }
    reply();
  }
  std::promise<void> entered;
  std::promise<void> gate;
};

TEST(Calls, ASlowHandlerHoldsUpItsOwnClientOnly) {
  const auto object = std::make_shared<SlowCounter>();
  Pair pair({}, {}, object);
  auto blocked = pair.connect();
  auto other = pair.connect();
  auto slow = std::async(std::launch::async, [&] { blocked->slow(0); });
  object->entered.get_future().wait();
  for (int i = 0; i < 20; ++i) EXPECT_EQ(other->add(i, 1), i + 1);
  auto third = pair.connect();
  EXPECT_EQ(third->add(1, 1), 2);
  EXPECT_EQ(slow.wait_for(0ms), std::future_status::timeout);
  object->gate.set_value();
  slow.get();
}

TEST(Calls, ManySlowHandlersOfManyClientsRunAtOnce) {
  class CountingCounter : public Counter {
   public:
    void slow(Reply<void> reply, std::int32_t /*milliseconds*/) override {
      ++running;
      EXPECT_TRUE(eventually([&] { return running >= 6; }));
      reply();
    }
    std::atomic<int> running{0};
  };
  Pair pair({}, {}, std::make_shared<CountingCounter>());
  std::vector<std::future<void>> calls;
  for (int i = 0; i < 6; ++i) {
    calls.push_back(std::async(std::launch::async, [&] { pair.connect()->slow(0); }));
  }
  for (auto& call : calls) call.get();
}

TEST(Calls, RequestsOfOneClientAreHandledInOrder) {
  class OrderedCounter : public Counter {
   public:
    double add(double a, double b) override {
      EXPECT_EQ(running.fetch_add(1), 0);
      EXPECT_EQ(a, next);
      next += 1;
      running.fetch_sub(1);
      return a + b;
    }
    std::atomic<int> running{0};
    double next = 0;
  };
  const auto object = std::make_shared<OrderedCounter>();
  Pair pair({}, {}, object);
  auto counter = pair.connect();
  for (int i = 0; i < 500; ++i) EXPECT_EQ(counter->add(i, 0), i);
}

// Answers from another thread, and a deferred answer in between.
class DeferringCounter : public Counter {
 public:
  void slow(Reply<void> reply, std::int32_t milliseconds) override {
    if (milliseconds < 0) return;  // drops the reply
    const std::lock_guard lock(mutex);
    replies.push_back(std::move(reply));
  }
  std::mutex mutex;
  std::vector<Reply<void>> replies;
};

TEST(Calls, ADeferredAnswerLetsLaterRequestsPass) {
  const auto object = std::make_shared<DeferringCounter>();
  Pair pair({}, {}, object);
  auto counter = pair.connect();
  auto waiting = std::async(std::launch::async, [&] { counter->slow(0); });
  EXPECT_TRUE(eventually([&] {
    const std::lock_guard lock(object->mutex);
    return !object->replies.empty();
  }));
  EXPECT_EQ(counter->add(1, 2), 3);
  EXPECT_EQ(waiting.wait_for(0ms), std::future_status::timeout);
  object->replies.front()();
  waiting.get();
}

TEST(Calls, ADroppedReplyAnswersWithAnError) {
  Pair pair({}, {}, std::make_shared<DeferringCounter>());
  auto counter = pair.connect();
  EXPECT_EQ(error_of([&] { counter->slow(-1); }).code(), ErrorCode::operation_aborted);
}

TEST(Calls, ADeferredAnswerMayFail) {
  class FailingCounter : public Counter {
   public:
    void slow(Reply<void> reply, std::int32_t /*milliseconds*/) override {
      reply.fail(std::make_exception_ptr(Overrun("later")));
    }
  };
  Pair pair({}, {}, std::make_shared<FailingCounter>());
  auto counter = pair.connect();
  EXPECT_THROW(counter->slow(0), Overrun);
}

TEST(Calls, AHandlerMayCallAnotherServiceOfItsOwnNode) {
  class CallingCounter : public Counter {
   public:
    double add(double a, double b) override { return (*peer)->add(a, b) + 1; }
    Client<CounterStub>* peer = nullptr;
  };
  const auto object = std::make_shared<CallingCounter>();
  Pair pair({}, {}, object);
  pair.server.register_service("plain", std::make_shared<Counter>());
  auto inner = pair.server.connect<CounterStub>(pair.url("plain"));
  object->peer = &inner;
  auto counter = pair.connect();
  EXPECT_EQ(counter->add(1, 2), 4);
}

TEST(Calls, ACallWithoutAnAnswerInTimeFailsAndTheNextOneWorks) {
  const auto object = std::make_shared<SlowCounter>();
  Pair pair({}, {}, object);
  auto counter = pair.connect();
  const auto before = Clock::now();
  with_options(within(60ms), [&] {
    EXPECT_EQ(error_of([&] { counter->slow(0); }).code(), ErrorCode::request_timeout);
  });
  EXPECT_GE(Clock::now() - before, 45ms);  // the clock of deadlines is coarse
  EXPECT_LT(Clock::now() - before, 5000ms);
  object->gate.set_value();
  EXPECT_EQ(counter->add(1, 2), 3);
}

TEST(Calls, AFollowerAlsoRunsOutOfTime) {
  const auto object = std::make_shared<SlowCounter>();
  Pair pair({}, {}, object);
  auto counter = pair.connect();
  auto reader = std::async(std::launch::async, [&] { counter->slow(0); });
  object->entered.get_future().wait();
  with_options(within(60ms), [&] {
    EXPECT_EQ(error_of([&] { counter->add(1, 2); }).code(), ErrorCode::request_timeout);
  });
  object->gate.set_value();
  reader.get();
}

TEST(Calls, ABlockingCallCanBeCancelled) {
  const auto object = std::make_shared<SlowCounter>();
  Pair pair({}, {}, object);
  auto counter = pair.connect();
  std::stop_source stop;
  auto call = std::async(std::launch::async, [&] {
    return with_options(stopped_by(stop.get_token()),
                        [&] { return error_of([&] { counter->slow(0); }).code(); });
  });
  object->entered.get_future().wait();
  const auto before = Clock::now();
  stop.request_stop();
  EXPECT_EQ(call.get(), ErrorCode::operation_cancelled);
  EXPECT_LT(Clock::now() - before, 900ms);
  with_options(stopped_by(stop.get_token()), [&] {
    EXPECT_EQ(error_of([&] { counter->add(1, 2); }).code(), ErrorCode::operation_cancelled);
  });
  object->gate.set_value();
}

TEST(Calls, ASessionsCallsCanBeCancelledTogether) {
  const auto object = std::make_shared<SlowCounter>();
  Pair pair({}, {}, object);
  auto counter = pair.connect();
  auto first =
      std::async(std::launch::async, [&] { return error_of([&] { counter->slow(0); }).code(); });
  object->entered.get_future().wait();
  auto second = counter->async_add(1, 2, boost::asio::use_future);  // it has begun
  counter.cancel_calls();
  EXPECT_EQ(first.get(), ErrorCode::operation_cancelled);
  EXPECT_EQ(code_of([&] { second.get(); }), ErrorCode::operation_cancelled);
  object->gate.set_value();
  EXPECT_EQ(counter->add(1, 2), 3);
}

TEST(Calls, OpenCallsFailWhenTheServiceGoesAway) {
  const auto object = std::make_shared<SlowCounter>();
  auto pair = std::make_unique<Pair>(NodeOptions{}, NodeOptions{}, object);
  auto counter = pair->connect();
  auto call =
      std::async(std::launch::async, [&] { return error_of([&] { counter->slow(0); }).code(); });
  object->entered.get_future().wait();
  auto end = std::async(std::launch::async, [&] { pair->server.shutdown(); });
  EXPECT_EQ(call.get(), ErrorCode::connection_error);
  object->gate.set_value();
  end.get();
  EXPECT_TRUE(eventually([&] { return !counter.is_open(); }));
  EXPECT_NE(error_of([&] { counter->add(1, 2); }).code(), ErrorCode::none);
}

TEST(Calls, OpenCallsFailWhenTheClientsNodeIsShutDown) {
  const auto object = std::make_shared<SlowCounter>();
  Pair pair({}, {}, object);
  auto counter = pair.connect();
  auto call =
      std::async(std::launch::async, [&] { return error_of([&] { counter->slow(0); }).code(); });
  object->entered.get_future().wait();
  pair.client.shutdown();
  EXPECT_EQ(call.get(), ErrorCode::connection_error);
  object->gate.set_value();
}

TEST(Calls, PipelinedCallsOfManyThreadsSurviveAClosingClient) {
  Pair pair;
  for (int round = 0; round < 10; ++round) {
    auto counter = pair.connect();
    const auto stub = counter.stub();
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t) {
      threads.emplace_back([&] {
        for (int i = 0; i < 1000; ++i) {
          if (error_of([&] { stub->add(1, 2); }).code() != ErrorCode::none) return;
        }
      });
    }
    std::this_thread::sleep_for(5ms);
    counter.close();
    for (std::thread& thread : threads) thread.join();
  }
}

TEST(Calls, AStubOutlivesItsClientAndItsNode) {
  std::shared_ptr<CounterStub> stub;
  {
    Pair pair;
    stub = pair.connect().stub();
  }
  EXPECT_NE(error_of([&] { stub->add(1, 2); }).code(), ErrorCode::none);
}

}  // namespace
}  // namespace rr::testing
