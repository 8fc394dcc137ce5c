// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <mutex>
#include <semaphore>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "rr/timer.hpp"
#include "runtime/cpp/src/node/testing/gate.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""h;
using Clock = std::chrono::steady_clock;

TEST(Timers, CallAgainAndAgainUntilTheyAreCancelled) {
  Node node;
  std::counting_semaphore calls(0);
  std::atomic<int> count{0};
  const Clock::time_point start = Clock::now();
  Timer timer = node.every(5ms, [&] {
    ++count;
    calls.release();
  });
  for (int i = 0; i < 4; ++i) calls.acquire();
  EXPECT_GE(Clock::now() - start, 20ms);
  EXPECT_TRUE(timer.is_running());
  timer.cancel();
  EXPECT_FALSE(timer.is_running());
  const int before = count;
  std::promise<void> later;
  const Timer end = node.after(30ms, [&] { later.set_value(); });
  later.get_future().get();
  EXPECT_EQ(count, before);
}

TEST(Timers, CallOnce) {
  Node node;
  std::atomic<int> count{0};
  std::promise<void> called;
  const Clock::time_point start = Clock::now();
  const Timer once = node.after(10ms, [&] {
    ++count;
    called.set_value();
  });
  called.get_future().get();
  EXPECT_GE(Clock::now() - start, 10ms);
  std::promise<void> later;
  const Timer end = node.after(20ms, [&] { later.set_value(); });
  later.get_future().get();
  EXPECT_EQ(count, 1);
  EXPECT_FALSE(once.is_running());
}

TEST(Timers, EndWhenTheyAreDestroyedOrReplaced) {
  Node node;
  const auto owned = std::make_shared<int>(1);
  {
    const Timer dropped = node.after(1h, [owned] {});
    EXPECT_EQ(owned.use_count(), 2);
  }
  EXPECT_EQ(owned.use_count(), 1);
  Timer timer = node.every(1h, [owned] {});
  timer = node.every(1h, [] {});
  EXPECT_EQ(owned.use_count(), 1);
  Timer moved = std::move(timer);
  EXPECT_TRUE(moved.is_running());
  EXPECT_FALSE(Timer().is_running());
}

TEST(Timers, CancelWaitsForACallThatRuns) {
  Node node;
  Gate gate;
  std::atomic<bool> has_ended{false};
  Timer timer = node.every(1ms, [&] {
    gate.pass();
    has_ended = true;
  });
  ASSERT_TRUE(gate.has_entered());
  std::thread opener([&] {
    std::this_thread::sleep_for(20ms);
    gate.open();
  });
  timer.cancel();
  EXPECT_TRUE(has_ended);
  opener.join();
}

TEST(Timers, MayCancelThemselves) {
  Node node;
  std::atomic<int> count{0};
  std::promise<void> called;
  Timer timer;
  std::mutex made;
  {
    const std::lock_guard lock(made);
    timer = node.every(1ms, [&] {
      const std::lock_guard wait(made);
      ++count;
      timer.cancel();
      called.set_value();  // a second call would throw
    });
  }
  called.get_future().get();
  std::promise<void> later;
  const Timer end = node.after(20ms, [&] { later.set_value(); });
  later.get_future().get();
  EXPECT_EQ(count, 1);
}

// The times are kept: a call that takes three periods leaves out those it overlaps, and the next
// one comes at a multiple of the period.
TEST(Timers, LeaveOutWhatASlowCallOverlaps) {
  Node node;
  std::counting_semaphore calls(0);
  std::atomic<int> running{0};
  std::atomic<bool> overlapped{false};
  std::mutex mutex;
  std::vector<Clock::time_point> times;
  constexpr auto period = 20ms;
  const Clock::time_point start = Clock::now();
  Timer timer = node.every(period, [&] {
    if (++running != 1) overlapped = true;
    {
      const std::lock_guard lock(mutex);
      times.push_back(Clock::now());
    }
    std::this_thread::sleep_for(2 * period + period / 2);
    --running;
    calls.release();
  });
  for (int i = 0; i < 3; ++i) calls.acquire();
  timer.cancel();
  EXPECT_FALSE(overlapped);
  ASSERT_GE(times.size(), 3U);
  EXPECT_GE(times[0] - start, period);
  EXPECT_GE(times[1] - start, 4 * period);
  EXPECT_GE(times[2] - start, 7 * period);
}

TEST(Timers, GoOnAfterAnException) {
  std::mutex mutex;
  std::vector<std::string> lines;
  NodeOptions options;
  options.log = [&](LogLevel level, std::string_view text) {
    if (level != LogLevel::error) return;
    const std::lock_guard lock(mutex);
    lines.emplace_back(text);
  };
  Node node(options);
  std::counting_semaphore calls(0);
  Timer timer = node.every(1ms, [&] {
    calls.release();
    throw std::runtime_error("no paper");
  });
  for (int i = 0; i < 2; ++i) calls.acquire();
  timer.cancel();
  const std::lock_guard lock(mutex);
  ASSERT_GE(lines.size(), 2U);
  EXPECT_EQ(lines.front(), "a timer's function has thrown: no paper");
}

TEST(Timers, RefuseWhatCannotBe) {
  Node node;
  EXPECT_EQ(error_of([&] { static_cast<void>(node.every(0ms, [] {})); }).code(),
            ErrorCode::invalid_argument);
  EXPECT_EQ(error_of([&] { static_cast<void>(node.every(-1ms, [] {})); }).code(),
            ErrorCode::invalid_argument);
  EXPECT_EQ(error_of([&] { static_cast<void>(node.after(1ms, nullptr)); }).code(),
            ErrorCode::invalid_argument);
  const Timer longest = node.every(std::chrono::nanoseconds::max(), [] {});
  EXPECT_TRUE(longest.is_running());
  node.shutdown();
  EXPECT_EQ(error_of([&] { static_cast<void>(node.every(1ms, [] {})); }).code(),
            ErrorCode::invalid_operation);
}

TEST(Timers, EndWithTheirNode) {
  std::atomic<int> count{0};
  Timer timer;
  {
    Node node;
    timer = node.every(1ms, [&] { ++count; });
    EXPECT_TRUE(eventually([&] { return count > 2; }));
    node.shutdown();
    const int before = count;
    std::this_thread::sleep_for(10ms);
    EXPECT_EQ(count, before);
  }
  timer.cancel();
}

// An object starts one with what it knows: its service's node.
TEST(Timers, AreFoundByAnObjectThroughItsService) {
  class Ticking : public Counter {
   public:
    using Counter::Counter;
    void rr_attached(ServiceContext& context, const std::string& path) override {
      where = rr_path() + " at " + context.node().name() + ", " + rr_service()->name();
      EXPECT_EQ(path, rr_path());
      timer_ = context.node().every(1ms, [this] { rr_fire_ticked(++ticks_, "tick"); });
    }
    std::string where;

   private:
    int ticks_ = 0;
    Timer timer_;
  };
  const auto ticking = std::make_shared<Ticking>();
  EXPECT_EQ(ticking->rr_path(), "");
  EXPECT_EQ(ticking->rr_service(), nullptr);
  NodeOptions options;
  options.name = "clock";
  Pair pair(options, {}, ticking);
  EXPECT_EQ(ticking->where, "counter at clock, counter");
  auto counter = pair.connect();
  std::promise<std::int32_t> ticked;
  std::once_flag once;
  const Subscription ticks = counter->ticked().connect([&](std::int32_t count, const std::string&) {
    std::call_once(once, [&] { ticked.set_value(count); });
  });
  EXPECT_GT(ticked.get_future().get(), 0);
  pair.service->close();
  EXPECT_EQ(ticking->rr_path(), "");
  EXPECT_EQ(ticking->rr_service(), nullptr);
}

}  // namespace
}  // namespace rr::testing
