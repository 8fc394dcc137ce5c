// SPDX-License-Identifier: Apache-2.0
#include "gateway/worker.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>
#include <vector>

#include "gateway/testing/waiting.hpp"

namespace rr::gateway {
namespace {

using std::chrono::milliseconds;
using testing::comes_true;

/// A task that lasts until it is let go.
struct Gate {
  std::promise<void> opened;
  std::shared_future<void> open = opened.get_future().share();
  std::atomic<bool> is_reached{false};
};

TEST(GatewayWorker, DoesWhatIsPostedInOrder) {
  std::vector<int> done;
  Worker worker(milliseconds(1), [] {});
  for (int i = 0; i < 100; ++i) worker.post([&done, i] { done.push_back(i); });
  worker.start();
  std::promise<void> last;
  worker.post([&] { last.set_value(); });
  last.get_future().wait();
  ASSERT_EQ(done.size(), 100U);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(done[static_cast<std::size_t>(i)], i);
}

TEST(GatewayWorker, TicksBesideTasks) {
  std::atomic<int> ticks{0};
  std::atomic<bool> ends{false};
  Worker worker(milliseconds(1), [&] { ++ticks; });
  worker.start();
  std::thread busy([&] {
    while (!ends) worker.post_in_turn([] {});
  });
  EXPECT_TRUE(comes_true([&] { return ticks > 10; }));
  ends = true;
  busy.join();
}

TEST(GatewayWorker, ASlowTickLeavesTimeForTasks) {
  Worker worker(milliseconds(1), [] { std::this_thread::sleep_for(milliseconds(5)); });
  worker.start();
  std::atomic<int> done{0};
  for (int i = 0; i < 100; ++i) worker.post([&] { ++done; });
  EXPECT_TRUE(comes_true([&] { return done == 100; }));
}

TEST(GatewayWorker, PostingWaitsForRoomUntilItNeedNot) {
  Gate gate;
  Worker worker(milliseconds(1'000), [] {});
  worker.start();
  worker.post([&] {
    gate.is_reached = true;
    gate.open.wait();
  });
  ASSERT_TRUE(comes_true([&] { return gate.is_reached.load(); }));
  worker.post_in_turn([] {}, 1);
  auto second = std::async(std::launch::async, [&] { worker.post_in_turn([] {}, 1); });
  EXPECT_EQ(second.wait_for(milliseconds(50)), std::future_status::timeout);
  worker.set_bounded(false);
  second.wait();
  worker.set_bounded(true);
  auto third = std::async(std::launch::async, [&] { worker.post_in_turn([] {}, 1); });
  gate.opened.set_value();
  third.wait();
}

TEST(GatewayWorker, StoppingDropsWhatWaits) {
  Gate gate;
  const auto kept = std::make_shared<int>(1);
  Worker worker(milliseconds(1'000), [] {});
  worker.start();
  worker.post([&] {
    gate.is_reached = true;
    gate.open.wait();
  });
  worker.post([kept] { FAIL(); });
  ASSERT_TRUE(comes_true([&] { return gate.is_reached.load(); }));
  auto stopping = std::async(std::launch::async, [&] { worker.stop(); });
  // From now on nothing is taken any more.
  EXPECT_TRUE(comes_true([&] {
    const long before = kept.use_count();
    worker.post([kept] {});
    return kept.use_count() == before;
  }));
  gate.opened.set_value();
  stopping.wait();
  EXPECT_EQ(kept.use_count(), 1);
}

}  // namespace
}  // namespace rr::gateway
