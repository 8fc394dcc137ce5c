// SPDX-License-Identifier: Apache-2.0
// Clients whose handlers block as many threads as they can, and others that only ask for a number.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/use_future.hpp>
#include <chrono>
#include <future>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "rr/call.hpp"
#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/node/testing/async_counter.hpp"
#include "runtime/cpp/src/node/testing/board.hpp"
#include "runtime/cpp/src/node/testing/gate.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/process_state.hpp"

namespace rr::testing {
namespace {

using boost::asio::use_future;
using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using Clock = std::chrono::steady_clock;

// What so many short calls took, shortest first.
template <class Call>
std::vector<std::chrono::microseconds> times_of(int count, const Call& call) {
  std::vector<std::chrono::microseconds> times;
  for (int i = 0; i < count; ++i) {
    const auto begin = Clock::now();
    call();
    times.push_back(std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - begin));
  }
  std::sort(times.begin(), times.end());
  return times;
}

std::chrono::microseconds p99(const std::vector<std::chrono::microseconds>& times) {
  return times[times.size() * 99 / 100];
}

// For who reads the figures: --gtest_output=xml.
void record(std::chrono::microseconds idle, std::chrono::microseconds busy) {
  ::testing::Test::RecordProperty("p99_us_idle", std::to_string(idle.count()));
  ::testing::Test::RecordProperty("p99_us_busy", std::to_string(busy.count()));
}

// Generous: other processes run on this machine. What is looked for takes seconds.
std::chrono::microseconds allowed(std::chrono::microseconds idle) {
  return std::max<std::chrono::microseconds>(10 * idle, 100ms);
}

class Blocking : public Counter {
 public:
  void slow(Reply<void> reply, std::int32_t /*milliseconds*/) override {
    gate.pass();
    reply();
  }
  Gate gate;
};

TEST(ThreadsOfANode, OneHundredSlowHandlersHoldUpNobody) {
  const auto object = std::make_shared<Blocking>();
  Pair pair({}, {.max_threads = 256}, object);
  const OpenAtEnd open_at_end(object->gate);
  auto other = pair.connect();
  const auto idle = p99(times_of(300, [&] { other->add(1, 2); }));
  std::vector<Client<CounterStub>> clients;
  std::vector<std::future<void>> calls;
  for (int i = 0; i < 100; ++i) {
    clients.push_back(pair.connect());
    calls.push_back(clients.back()->async_slow(0, use_future));
  }
  ASSERT_TRUE(object->gate.has_entered(100));
  const auto busy = p99(times_of(300, [&] { other->add(1, 2); }));
  record(idle, busy);
  EXPECT_LT(busy, allowed(idle));
  EXPECT_EQ(pair.connect()->add(1, 2), 3);  // a new one comes in
  object->gate.open();
  for (auto& call : calls) call.get();
}

// More than there are threads, all of the address of the other client.
TEST(ThreadsOfANode, MoreSlowHandlersThanThreadsHoldUpNobodyWhoHasBeenShort) {
  if (slowness() > 1) GTEST_SKIP() << "no handler of this build is short";
  const auto object = std::make_shared<Blocking>();
  Pair pair({.max_threads = 16}, {.max_threads = 256}, object);
  const OpenAtEnd open_at_end(object->gate);
  auto other = pair.connect();
  const auto idle = p99(times_of(300, [&] { other->add(1, 2); }));
  std::vector<Client<CounterStub>> clients;
  std::vector<std::future<void>> calls;
  for (int i = 0; i < 40; ++i) clients.push_back(pair.connect());
  for (auto& client : clients) calls.push_back(client->async_slow(0, use_future));
  ASSERT_TRUE(object->gate.has_entered(10));
  EXPECT_LT(p99(times_of(300, [&] { other->add(1, 2); })), allowed(idle));
  EXPECT_LE(object->gate.entered(), 14);  // all but the two that poll and watch
  object->gate.open();
  for (auto& call : calls) call.get();  // those that had to wait run, too
  EXPECT_EQ(object->gate.entered(), 40);
}

// A member that waits for a callback keeps a thread; its client's next request may start another.
struct Unanswered : BoardPair {
  Unanswered() : BoardPair({}, {.max_threads = 1000}) {
    object->on_run = [this](const std::string& what) -> double {
      if (what == "short") return 1;
      ++waiting;
      most = std::max(most.load(), waiting.load());
      const auto client = ServiceContext::current_client();
      with_options(within(60s), [&] { (void)error_of([&] { object->sum(client, 1, 2); }); });
      --waiting;
      return 0;
    };
  }
  // Asks for so many callbacks as one client, which answers none before the end.
  void begin(int calls) {
    boards.push_back(connect());
    boards.back()->sum().set([this](std::int32_t, std::int32_t) {
      is_over.wait();
      return 1;
    });
    for (int i = 0; i < calls; ++i) open.push_back(boards.back()->async_run("ask", use_future));
  }
  void end() {
    over.set_value();
    for (auto& call : open) call.wait();
  }

  std::promise<void> over;
  std::shared_future<void> is_over = over.get_future().share();
  std::vector<Client<BoardStub>> boards;
  std::vector<std::future<double>> open;
  std::atomic<int> waiting{0};
  std::atomic<int> most{0};
};

TEST(ThreadsOfANode, CallbacksThatOneClientLeavesUnansweredKeepItsShareOfThem) {
  Unanswered pair;
  auto other = pair.connect();
  pair.begin(40);
  ASSERT_TRUE(eventually([&] { return pair.waiting == 16; }));
  EXPECT_EQ(other->run("short"), 1);
  EXPECT_EQ(pair.waiting, 16);
  pair.end();
  EXPECT_EQ(pair.most, 16);
}

TEST(ThreadsOfANode, TwentyClientsThatLeaveCallbacksUnansweredHoldUpNobody) {
  Unanswered pair;
  auto other = pair.connect();
  const auto idle = p99(times_of(300, [&] { other->run("short"); }));
  for (int i = 0; i < 20; ++i) pair.begin(20);
  ASSERT_TRUE(eventually([&] { return pair.waiting > 60; }));
  const auto busy = p99(times_of(300, [&] { other->run("short"); }));
  record(idle, busy);
  EXPECT_LT(busy, allowed(idle));
  EXPECT_LT(pair.waiting, 100);
  auto late = pair.connect();
  EXPECT_EQ(late->run("short"), 1);
  pair.end();
}

// Each blocks for 20 ms, again and again: a stall of 5 ms each would leave others no time.
TEST(ThreadsOfANode, HandlersThatBlockAgainAndAgainHoldUpNobody) {
  class Sleeping : public Counter {
   public:
    void reset() override { std::this_thread::sleep_for(20ms); }
  };
  Pair pair({}, {.max_threads = 64}, std::make_shared<Sleeping>());
  auto other = pair.connect();
  const auto idle = times_of(300, [&] { other->add(1, 2); });
  std::atomic<bool> is_over{false};
  std::vector<std::thread> attackers;
  for (int i = 0; i < 20; ++i) {
    attackers.emplace_back([&, counter = pair.connect()] {
      while (!is_over) counter->reset();
    });
  }
  std::this_thread::sleep_for(300ms);  // until they are known
  const auto busy = times_of(300, [&] { other->add(1, 2); });
  is_over = true;
  for (std::thread& attacker : attackers) attacker.join();
  record(p99(idle), p99(busy));
  EXPECT_LT(busy[busy.size() / 2], std::max<std::chrono::microseconds>(10 * idle[150], 4ms));
  EXPECT_LT(p99(busy), allowed(p99(idle)));
}

// Threads that no system gives.
struct Scarce {
  std::atomic<bool> has_none{false};
  std::atomic<int> reports{0};
  channel::Reactor::Terms terms() {
    return {.max_threads = 8,
            .make_thread =
                [this](std::function<void()> run) {
                  if (has_none) {
                    throw std::system_error(EAGAIN, std::generic_category(), "no thread");
                  }
                  return std::thread(std::move(run));
                },
            .report = [this](std::string_view) { ++reports; }};
  }
};

TEST(ThreadsOfANode, GoOnWhenNoneCanBeMadeAndAreTriedAgain) {
  Scarce scarce;
  channel::Reactor reactor(scarce.terms());
  reactor.start();
  scarce.has_none = true;
  Gate gate;
  reactor.post([&] { gate.pass(); });
  ASSERT_TRUE(gate.has_entered());
  std::promise<void> second;
  reactor.post([&] { second.set_value(); });
  auto is_done = second.get_future();
  EXPECT_TRUE(eventually([&] { return scarce.reports == 1; }));
  EXPECT_EQ(is_done.wait_for(50ms), std::future_status::timeout);  // there is nobody to do it
  EXPECT_EQ(scarce.reports, 1);
  scarce.has_none = false;
  EXPECT_EQ(is_done.wait_for(20s), std::future_status::ready);
  EXPECT_EQ(reactor.held(), 1U);
  gate.open();
  reactor.stop();
}

// A wait in a handler, where another thread would have to poll.
TEST(ThreadsOfANode, MayWaitWhenNoneCanBeMade) {
  Scarce scarce;
  channel::Reactor reactor(scarce.terms());
  reactor.start();
  scarce.has_none = true;
  std::promise<void> done;
  reactor.post([&] {
    channel::Reactor::about_to_wait();
    done.set_value();
  });
  EXPECT_EQ(done.get_future().wait_for(20s), std::future_status::ready);
  EXPECT_TRUE(eventually([&] { return scarce.reports == 1; }));
  reactor.stop();
}

TEST(ThreadsOfANode, WorkOfASessionWaitsForItsShareAndTheOthersDoesNot) {
  channel::Reactor reactor(channel::Reactor::Terms{.max_threads = 32, .session_threads = 2});
  reactor.start();
  const auto greedy = reactor.open_share("10.0.0.1");
  const auto modest = reactor.open_share("10.0.0.2");
  Gate gate;
  for (int i = 0; i < 5; ++i) reactor.post([&] { gate.pass(); }, greedy);
  ASSERT_TRUE(gate.has_entered(2));
  EXPECT_TRUE(eventually([&] { return reactor.held() == 2 && reactor.waiting() == 3; }));
  std::promise<void> other;
  reactor.post([&] { other.set_value(); }, modest);
  EXPECT_EQ(other.get_future().wait_for(20s), std::future_status::ready);
  EXPECT_EQ(gate.entered(), 2);
  gate.open();
  EXPECT_TRUE(gate.has_entered(5));
  EXPECT_TRUE(eventually([&] { return reactor.held() == 0 && reactor.waiting() == 0; }));
  reactor.stop();
}

TEST(ThreadsOfANode, WhatWaitsForThemRunsWhenTheNodeEnds) {
  channel::Reactor reactor(channel::Reactor::Terms{.max_threads = 32, .session_threads = 1});
  reactor.start();
  const auto share = reactor.open_share("10.0.0.1");
  Gate gate;
  std::atomic<int> ran{0};
  for (int i = 0; i < 4; ++i) {
    reactor.post(
        [&] {
          gate.pass();
          ++ran;
        },
        share);
  }
  ASSERT_TRUE(gate.has_entered());
  EXPECT_TRUE(eventually([&] { return reactor.waiting() == 3; }));
  auto opener = std::async(std::launch::async, [&] {
    std::this_thread::sleep_for(20ms);
    gate.open();
  });
  reactor.stop();
  EXPECT_EQ(ran, 4);
}

}  // namespace
}  // namespace rr::testing
