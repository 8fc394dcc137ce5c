// SPDX-License-Identifier: Apache-2.0
#include "rr/realtime/cyclic_loop.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "rr/error.hpp"
#include "rr/realtime/lockstep.hpp"

namespace rr::realtime {
namespace {

using namespace std::chrono_literals;

TEST(RealtimeLoop, RunsAtItsRateFromOnePeriodAfterItsStart) {
  SimulatedClock clock;
  clock.set(5ms);
  CyclicLoop loop(1ms, clock);
  std::vector<Nanoseconds> times;
  loop.run([&](const Cycle& cycle) {
    EXPECT_EQ(cycle.number, times.size());
    EXPECT_EQ(cycle.due, clock.now());
    times.push_back(clock.now());
    if (times.size() == 3) loop.stop();
  });
  EXPECT_EQ(times, (std::vector<Nanoseconds>{6ms, 7ms, 8ms}));
  EXPECT_EQ(loop.counts().cycles, 3U);
  EXPECT_EQ(loop.counts().overruns, 0U);
  EXPECT_EQ(loop.counts().lateness.largest(), 0ns);
}

TEST(RealtimeLoop, CountsOverrunsSkipsWhatHasPassedAndKeepsItsPhase) {
  SimulatedClock clock;
  CyclicLoop loop(1ms, clock);
  std::vector<std::uint64_t> numbers;
  std::vector<Nanoseconds> begins;
  loop.run([&](const Cycle& cycle) {
    numbers.push_back(cycle.number);
    begins.push_back(clock.now());
    if (cycle.number == 1) clock.set(clock.now() + 1200us);  // a little too long
    if (cycle.number == 3) clock.set(clock.now() + 3500us);  // three periods too long
    if (numbers.size() == 6) loop.stop();
  });
  EXPECT_EQ(numbers, (std::vector<std::uint64_t>{0, 1, 2, 3, 6, 7}));
  EXPECT_EQ(begins, (std::vector<Nanoseconds>{1ms, 2ms, 3200us, 4ms, 7500us, 8ms}));
  EXPECT_EQ(loop.counts().overruns, 2U);
  EXPECT_EQ(loop.counts().skipped, 2U);
  EXPECT_EQ(loop.counts().lateness.largest(), 500us);
  EXPECT_EQ(loop.counts().duration.largest(), 3500us);
}

TEST(RealtimeLoop, AHistogramKnowsItsQuantiles) {
  JitterHistogram histogram;
  for (int i = 0; i < 999; ++i) histogram.add(3500ns);
  histogram.add(20ms);
  EXPECT_EQ(histogram.count(), 1000U);
  EXPECT_EQ(histogram.quantile(0.5), 4us);
  EXPECT_EQ(histogram.quantile(0.999), 4us);
  EXPECT_EQ(histogram.quantile(1), 20ms);
  EXPECT_EQ(histogram.mean(), Nanoseconds((999 * 3500 + 20'000'000) / 1000));
  EXPECT_EQ(histogram.bins()[3], 999U);
  EXPECT_EQ(histogram.bins().back(), 1U);
}

TEST(RealtimeLoop, RefusesAPeriodOfNothing) {
  SimulatedClock clock;
  EXPECT_THROW(CyclicLoop(0ns, clock), Error);
}

TEST(RealtimeLoop, TheMachinesClockIsSleptOnUntilItsTime) {
  SteadyClock clock;
  CyclicLoop loop(2ms, clock);
  Nanoseconds earliest = 1h;
  loop.run([&](const Cycle& cycle) {
    earliest = std::min(earliest, clock.now() - cycle.due);
    if (cycle.number >= 5) loop.stop();
  });
  EXPECT_GE(earliest, 0ns);
  EXPECT_GE(loop.counts().cycles, 1U);
}

TEST(RealtimeLoop, LockstepRunsWhatIsDueFirstInOrder) {
  Lockstep lockstep;
  std::string order;
  lockstep.add(2ms, [&](const Cycle&) { order += 'a'; });
  lockstep.add(3ms, [&](const Cycle&) { order += 'b'; });
  lockstep.add(2ms, [&](const Cycle&) { order += 'c'; });
  lockstep.run_until(6ms);
  EXPECT_EQ(order, "acbacabc");
  EXPECT_EQ(lockstep.clock().now(), 6ms);
}

}  // namespace
}  // namespace rr::realtime
