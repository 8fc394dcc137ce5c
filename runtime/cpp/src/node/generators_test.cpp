// SPDX-License-Identifier: Apache-2.0
#include "rr/generators.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/use_future.hpp>
#include <chrono>
#include <future>
#include <mutex>
#include <thread>
#include <vector>

#include "rr/async.hpp"
#include "rr/call.hpp"
#include "runtime/cpp/src/node/testing/board.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::testing {
namespace {

using boost::asio::use_awaitable;
using boost::asio::use_future;
using ::testing::ElementsAre;
using std::chrono_literals::operator""ms;

TEST(Generators, GiveTheirValuesAndEnd) {
  BoardPair pair;
  auto board = pair.connect();
  auto counter = board->count_to(2);
  EXPECT_EQ(counter.next(), 1);
  EXPECT_EQ(counter.next(), 2);
  EXPECT_EQ(counter.next(), std::nullopt);
  const Error error = error_of([&] { counter.next(); });
  EXPECT_EQ(error.code(), ErrorCode::invalid_operation);
  EXPECT_EQ(error.message(), "Invalid generator");
}

TEST(Generators, AreRangesAndGiveAllThatIsLeft) {
  BoardPair pair;
  auto board = pair.connect();
  std::vector<std::int32_t> seen;
  for (const std::int32_t value : board->count_to(3)) seen.push_back(value);
  EXPECT_THAT(seen, ElementsAre(1, 2, 3));
  auto counter = board->count_to(4);
  counter.next();
  EXPECT_THAT(counter.all(), ElementsAre(2, 3, 4));
  EXPECT_THAT(board->count_to(0).all(), ElementsAre());
}

TEST(Generators, GiveStructsAndLargeArrays) {
  BoardPair pair;
  auto board = pair.connect();
  const auto notes = board->notes().all();
  ASSERT_EQ(notes.size(), 3U);
  EXPECT_EQ(notes[0], (Note{"first", {1, 2}}));
  EXPECT_EQ(notes[1], std::nullopt);
  EXPECT_EQ(notes[2]->text, "last");
  EXPECT_EQ(notes[2]->numbers.size(), 100'000U);
}

TEST(Generators, TakeValues) {
  BoardPair pair;
  std::vector<std::pair<std::string, double>> taken_values;
  pair.object->on_collect = [&](const std::string& label, double value) {
    taken_values.emplace_back(label, value);
  };
  auto board = pair.connect();
  auto sink = board->collect("left");
  EXPECT_TRUE(sink.next(0.5));
  EXPECT_TRUE(sink.next(-2));
  EXPECT_FALSE(sink.next(7));
  EXPECT_THAT(taken_values, ElementsAre(std::pair("left", 0.5), std::pair("left", -2.0)));
  EXPECT_EQ(code_of([&] { sink.next(1); }), ErrorCode::invalid_operation);
}

TEST(Generators, TakeAndGiveInEachStep) {
  BoardPair pair;
  auto board = pair.connect();
  auto sum = board->running_sum(10);
  EXPECT_EQ(sum.next(1), 11);
  EXPECT_EQ(sum.next(-20.5), -9.5);
  EXPECT_EQ(sum.next(200), 190.5);
}

TEST(Generators, ThatTakeTwiceWithoutGivingFail) {
  BoardPair pair;
  auto board = pair.connect();
  auto sum = board->running_sum(100);
  EXPECT_EQ(code_of([&] { sum.next(1); }), ErrorCode::internal_error);
  EXPECT_EQ(code_of([&] { sum.next(1); }), ErrorCode::invalid_operation);
}

TEST(Generators, MayBeRefusedByTheFunction) {
  BoardPair pair;
  auto board = pair.connect();
  const Error error = error_of([&] { board->count_to(-1); });
  EXPECT_EQ(error.code(), ErrorCode::permission_denied);
  EXPECT_EQ(error.message(), "no generator for you");
}

TEST(Generators, EndByWhatTheyThrow) {
  BoardPair pair;
  auto board = pair.connect();
  auto names = board->names("gate");
  EXPECT_EQ(names.next(), "north gate");
  EXPECT_EQ(names.next(), "south gate");
  try {
    names.next();
    FAIL() << "nothing was thrown";
  } catch (const Jam& jam) {
    EXPECT_EQ(jam.message(), "stuck at gate");
    EXPECT_EQ(jam.subname(), "deep");
    EXPECT_EQ(jam.parameter(), VarValue(Array<double>{0.5, -0.25}));
  }
  EXPECT_EQ(code_of([&] { names.next(); }), ErrorCode::invalid_operation);
}

TEST(Generators, ThatAreClosedAreDestroyedAndKnownForOneMoreStep) {
  BoardPair pair;
  pair.object->held = std::make_shared<int>();
  const std::weak_ptr<void> watch = pair.object->held;
  auto board = pair.connect();
  auto counter = board->count_to(10);
  pair.object->held.reset();
  EXPECT_EQ(counter.next(), 1);
  EXPECT_FALSE(watch.expired());
  counter.close();
  EXPECT_TRUE(watch.expired());
  counter.close();
  EXPECT_EQ(counter.next(), std::nullopt);
  EXPECT_EQ(code_of([&] { counter.next(); }), ErrorCode::invalid_operation);
}

TEST(Generators, ThatAreAbortedAreDestroyedAndSaySo) {
  BoardPair pair;
  pair.object->held = std::make_shared<int>();
  const std::weak_ptr<void> watch = pair.object->held;
  auto board = pair.connect();
  auto counter = board->count_to(10);
  pair.object->held.reset();
  counter.abort();
  EXPECT_TRUE(watch.expired());
  const Error error = error_of([&] { counter.next(); });
  EXPECT_EQ(error.code(), ErrorCode::operation_aborted);
  EXPECT_EQ(error.message(), "generator was aborted");
}

TEST(Generators, AreClosedWhenTheirLastHandleGoes) {
  BoardPair pair;
  pair.object->held = std::make_shared<int>();
  const std::weak_ptr<void> watch = pair.object->held;
  auto board = pair.connect();
  {
    auto counter = board->count_to(10);
    const auto copy = counter;
    pair.object->held.reset();
    counter = {};
    EXPECT_EQ(Generator<std::int32_t>(copy).next(), 1);
  }
  EXPECT_TRUE(eventually([&] { return watch.expired(); }));
  EXPECT_EQ(code_of([] { Generator<std::int32_t>().next(); }), ErrorCode::invalid_operation);
}

// A generator without a coroutine.
class Own final : public GeneratorOf<std::int32_t> {
 public:
  Own(std::string& log, int count) : log_(log), count_(count) {}
  ~Own() override { log_ += "gone "; }
  std::optional<std::int32_t> next() override {
    log_ += "next ";
    if (count_ == 0) return std::nullopt;
    return count_--;
  }
  void close() override { log_ += "close "; }
  void abort() override { log_ += "abort "; }

 private:
  std::string& log_;
  int count_;
};

TEST(Generators, MayBeWrittenWithoutACoroutine) {
  BoardPair pair;
  std::string log;
  pair.object->on_count_to = [&](std::int32_t limit) -> Sequence<std::int32_t> {
    return std::make_shared<Own>(log, limit);
  };
  auto board = pair.connect();
  EXPECT_THAT(board->count_to(2).all(), ElementsAre(2, 1));
  EXPECT_EQ(log, "next next next gone ");
  log.clear();
  board->count_to(2).close();
  EXPECT_EQ(log, "close gone ");
  log.clear();
  board->count_to(2).abort();
  EXPECT_EQ(log, "abort gone ");
}

TEST(Generators, ThatAreNoneAreAnError) {
  BoardPair pair;
  pair.object->on_count_to = [](std::int32_t) -> Sequence<std::int32_t> {
    return std::shared_ptr<Own>();
  };
  auto board = pair.connect();
  EXPECT_EQ(code_of([&] { board->count_to(2); }), ErrorCode::internal_error);
}

TEST(Generators, GoWhenTheirClientLeaves) {
  BoardPair pair;
  pair.object->held = std::make_shared<int>();
  const std::weak_ptr<void> watch = pair.object->held;
  auto board = pair.connect();
  auto counter = board->count_to(10);
  pair.object->held.reset();
  counter.next();
  board.close();
  EXPECT_TRUE(eventually([&] { return watch.expired(); }));
  EXPECT_NE(code_of([&] { counter.next(); }), ErrorCode::none);
}

TEST(Generators, AreNotDestroyedWhileAStepRuns) {
  std::promise<void> entered;
  std::promise<void> gate;
  BoardPair pair;
  pair.object->held = std::make_shared<int>();
  const std::weak_ptr<void> watch = pair.object->held;
  std::atomic<bool> was_there{false};
  pair.object->on_step = [&](std::int32_t) {
    entered.set_value();
    gate.get_future().wait();
    was_there = !watch.expired();
  };
  auto board = pair.connect();
  auto counter = board->count_to(10);
  pair.object->held.reset();
  auto step = counter.async_next(use_future);
  entered.get_future().wait();
  pair.service->disconnect(pair.only_client());
  EXPECT_FALSE(watch.expired());
  gate.set_value();
  EXPECT_TRUE(eventually([&] { return watch.expired(); }));
  EXPECT_TRUE(was_there);
  step.wait();
}

// A board that says when it goes away.
class WatchedBoard final : public Board {
 public:
  explicit WatchedBoard(std::atomic<int>& alive) : alive_(alive) { ++alive_; }
  ~WatchedBoard() override { --alive_; }

 private:
  std::atomic<int>& alive_;
};

class ParentBoard final : public Board {
 public:
  explicit ParentBoard(std::atomic<int>& alive) : alive_(alive) {}
  std::shared_ptr<Skeleton> get_child() override { return std::make_shared<WatchedBoard>(alive_); }

 private:
  std::atomic<int>& alive_;
};

TEST(Generators, EndWithTheirObject) {
  BoardPair pair;
  std::atomic<int> alive{0};
  auto service = pair.server.register_service("parent", std::make_shared<ParentBoard>(alive));
  auto board = pair.client.connect<BoardStub>("rr+tcp://127.0.0.1:" + std::to_string(pair.port) +
                                              "/?service=parent");
  auto names = board->get_child()->names("x");
  EXPECT_EQ(names.next(), "north x");
  EXPECT_EQ(alive, 1);
  service->release_path("parent.child");
  EXPECT_EQ(code_of([&] { names.next(); }), ErrorCode::invalid_operation);
  service->release_path("parent.child");
  board->run("x");
  EXPECT_TRUE(eventually([&] { return alive == 0; }));
}

TEST(Generators, OfAnotherObjectAreNotFound) {
  BoardPair pair;
  auto board = pair.connect();
  auto other = pair.connect();
  auto mine = board->count_to(3);
  auto theirs = other->get_child()->count_to(9);
  EXPECT_EQ(theirs.next(), 1);
  EXPECT_EQ(mine.next(), 1);
  EXPECT_EQ(theirs.next(), 2);
  EXPECT_EQ(mine.next(), 2);
}

TEST(Generators, ThatNobodyUsesAreDropped) {
  NodeOptions options;
  options.generator_timeout = 400ms;
  BoardPair pair(options);
  pair.object->held = std::make_shared<int>();
  const std::weak_ptr<void> watch = pair.object->held;
  auto board = pair.connect();
  auto counter = board->count_to(1000);
  pair.object->held.reset();
  auto closed = board->count_to(2);
  closed.close();
  for (int i = 1; i <= 20; ++i) {
    EXPECT_EQ(counter.next(), i);
    std::this_thread::sleep_for(25ms);
  }
  EXPECT_EQ(code_of([&] { closed.next(); }), ErrorCode::invalid_operation);
  EXPECT_TRUE(eventually([&] { return watch.expired(); }));
  EXPECT_EQ(code_of([&] { counter.next(); }), ErrorCode::invalid_operation);
  counter.close();
}

TEST(Generators, GoOnAfterAStepThatTookTooLong) {
  BoardPair pair;
  pair.object->on_step = [](std::int32_t value) {
    if (value == 1) std::this_thread::sleep_for(200ms);
  };
  auto board = pair.connect();
  auto counter = board->count_to(3);
  EXPECT_EQ(code_of([&] { counter.next(within(50ms)); }), ErrorCode::request_timeout);
  EXPECT_EQ(counter.next(), 2);
}

TEST(Generators, GiveEachValueOnceToManyThreads) {
  BoardPair pair;
  auto board = pair.connect();
  auto counter = board->count_to(400);
  std::mutex mutex;
  std::vector<std::int32_t> seen;
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      try {
        while (const auto value = counter.next()) {
          const std::lock_guard lock(mutex);
          seen.push_back(*value);
        }
      } catch (const Error& error) {  // another thread has found the end
        EXPECT_EQ(error.code(), ErrorCode::invalid_operation);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  std::sort(seen.begin(), seen.end());
  ASSERT_EQ(seen.size(), 400U);
  for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(seen[i], static_cast<int>(i) + 1);
}

TEST(Generators, KnowTheirClient) {
  BoardPair pair;
  std::uint32_t client = 0;
  pair.object->on_step = [&](std::int32_t) { client = ServiceContext::current_client(); };
  auto board = pair.connect();
  board->count_to(1).next();
  EXPECT_EQ(client, pair.only_client());
}

TEST(Generators, StepsThatComeWhileOneWaitsForACallbackAreTakenInOrder) {
  std::promise<void> gate;
  BoardPair pair;
  auto board = pair.connect();
  auto opened = gate.get_future().share();
  board->ping().set([&] { opened.wait(); });
  pair.object->on_step = [&](std::int32_t value) {
    if (value == 1) pair.object->ping(ServiceContext::current_client());
  };
  auto counter = board->count_to(100);
  std::vector<std::future<std::optional<std::int32_t>>> steps;
  for (int i = 0; i < 10; ++i) steps.push_back(counter.async_next(use_future));
  EXPECT_EQ(board->run("meanwhile"), 0);
  EXPECT_EQ(steps[0].wait_for(0ms), std::future_status::timeout);
  gate.set_value();
  for (int i = 0; i < 10; ++i) EXPECT_EQ(steps[static_cast<std::size_t>(i)].get(), i + 1);
}

TEST(Generators, StepsThatHaveWaitedRunBesideNoOtherRequestOfTheirClient) {
  std::promise<void> gate;
  BoardPair pair;
  auto board = pair.connect();
  auto opened = gate.get_future().share();
  std::atomic<int> inside{0};
  std::atomic<int> most_inside{0};
  const auto work = [&] {
    most_inside = std::max(most_inside.load(), ++inside);
    std::this_thread::sleep_for(2ms);
    --inside;
  };
  board->ping().set([&] { opened.wait(); });
  pair.object->on_step = [&](std::int32_t value) {
    if (value == 1) pair.object->ping(ServiceContext::current_client());
    work();
  };
  pair.object->on_run = [&](const std::string& what) {
    if (what == "end the wait") gate.set_value();
    work();
    return 0.0;
  };
  auto counter = board->count_to(100);
  std::vector<std::future<std::optional<std::int32_t>>> steps;
  for (int i = 0; i < 5; ++i) steps.push_back(counter.async_next(use_future));
  board->run("end the wait");
  for (int i = 0; i < 20; ++i) board->run("meanwhile");
  for (int i = 0; i < 5; ++i) EXPECT_EQ(steps[static_cast<std::size_t>(i)].get(), i + 1);
  EXPECT_EQ(most_inside, 1);
}

TEST(Generators, ManyStepsBehindOneThatWaitsAreRefusedRatherThanStuck) {
  std::promise<void> gate;
  BoardPair pair;
  auto board = pair.connect();
  auto opened = gate.get_future().share();
  board->ping().set([&] { opened.wait(); });
  pair.object->on_step = [&](std::int32_t value) {
    if (value == 1) pair.object->ping(ServiceContext::current_client());
  };
  auto counter = board->count_to(100);
  std::vector<std::future<std::optional<std::int32_t>>> steps;
  for (int i = 0; i < 40; ++i) steps.push_back(counter.async_next(use_future));
  EXPECT_EQ(code_of([&] { steps.back().get(); }), ErrorCode::member_busy);
  gate.set_value();
  EXPECT_EQ(steps.front().get(), 1);
  EXPECT_EQ(steps[10].get(), 11);
}

TEST(Generators, OpenStepsFailWhenANodeShutsDown) {
  std::promise<void> entered;
  BoardPair pair;
  pair.object->on_step = [&](std::int32_t) {
    entered.set_value();
    std::this_thread::sleep_for(100ms);
  };
  auto board = pair.connect();
  auto counter = board->count_to(3);
  auto step = counter.async_next(use_future);
  entered.get_future().wait();
  pair.server.shutdown();
  EXPECT_EQ(code_of([&] { step.get(); }), ErrorCode::connection_error);
}

boost::asio::awaitable<std::int32_t> add_up(BoardStub& board) {
  std::int32_t sum = 0;
  auto counter = co_await board.async_count_to(4, use_awaitable);
  while (const auto value = co_await counter.async_next(use_awaitable)) sum += *value;
  auto closed = co_await board.async_count_to(4, use_awaitable);
  co_await closed.async_close(use_awaitable);
  const auto end = co_await closed.async_next(use_awaitable);
  co_return end ? -1 : sum;
}

TEST(AsyncGenerators, AreAwaited) {
  BoardPair pair;
  auto board = pair.connect();
  boost::asio::io_context context;
  auto sum = boost::asio::co_spawn(context, add_up(*board), use_future);
  context.run();
  EXPECT_EQ(sum.get(), 10);
}

TEST(AsyncGenerators, GiveFutures) {
  BoardPair pair;
  auto board = pair.connect();
  auto sink = board->collect("x");
  EXPECT_TRUE(sink.async_next(1, use_future).get());
  EXPECT_TRUE(sink.async_next(2, use_future).get());
  EXPECT_FALSE(sink.async_next(3, use_future).get());
  auto sum = board->running_sum(1);
  EXPECT_EQ(sum.async_next(2, use_future).get(), 3);
  sum.async_abort(use_future).get();
  auto late = sum.async_next(2, use_future);
  EXPECT_EQ(code_of([&] { late.get(); }), ErrorCode::operation_aborted);
  sum.async_close(use_future).get();
  auto refused = board->async_count_to(-1, use_future);
  EXPECT_EQ(code_of([&] { refused.get(); }), ErrorCode::permission_denied);
}

TEST(AsyncGenerators, KeepTheirGeneratorWhileAStepIsOpen) {
  BoardPair pair;
  pair.object->on_step = [](std::int32_t) { std::this_thread::sleep_for(20ms); };
  auto board = pair.connect();
  auto step = board->count_to(3).async_next(use_future);
  EXPECT_EQ(step.get(), 1);
}

}  // namespace
}  // namespace rr::testing
