// SPDX-License-Identifier: Apache-2.0
// Wires whose values come through slots in shared memory: processes that are killed and stopped at
// any time, and a service that writes over what its readers see.
#include <gtest/gtest.h>
#include <signal.h>

#include <atomic>
#include <chrono>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "runtime/cpp/src/node/testing/child.hpp"
#include "runtime/cpp/src/node/testing/process_state.hpp"
#include "runtime/cpp/src/node/testing/wire_slots_rig.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""ms;

// Each time at another moment.
TEST_F(WireSlots, AReaderMayBeKilledAtAnyTime) {
  serve(options());
  auto level = connect(options())->level().connect();
  object_->trace().set_in(trace_of(10, 1));
  std::atomic<bool> is_over{false};
  std::thread publisher([&] {
    for (double value = 1; !is_over; ++value) {
      object_->level().set_in(value);
      object_->trace().set_in(trace_of(static_cast<std::size_t>(value) % 20'000, value));
    }
  });
  const std::size_t before = ProcessState::now().descriptors;
  std::mt19937 random(49);
  double last = 0;
  for (int round = 0; round < 100 / slowness(); ++round) {
    Child reader(words({"read", url()}), RR_SHARED_MEMORY_PEER);
    reader.wait_for("reading");
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 3000));
    reader.signal(SIGKILL);
    EXPECT_TRUE(eventually([&] { return level.in() > last; }));
    last = level.in();
  }
  is_over = true;
  publisher.join();
  EXPECT_TRUE(eventually([] { return published() == 1; })) << "that of the level";
  EXPECT_TRUE(eventually([&] { return ProcessState::now().descriptors <= before; }));
}

TEST_F(WireSlots, AServiceMayBeKilledAtAnyTime) {
  std::mt19937 random(50);
  for (int round = 0; round < 60 / slowness(); ++round) {
    {
      Child server(words({"publish"}), RR_SHARED_MEMORY_PEER);
      Node client(options());
      auto wired = client.connect<WiredStub>(server.wait_for("ready"));
      auto level = wired->level().connect();
      auto trace = wired->trace().connect();
      std::atomic<int> called{0};
      const Subscription subscription =
          level.on_in([&](double /*value*/, const TimeSpec& /*time*/) { ++called; });
      ASSERT_TRUE(trace.wait_in(plenty));
      std::atomic<bool> is_killed{false};
      std::thread killer([&, wait = random() % 3000] {
        std::this_thread::sleep_for(std::chrono::microseconds(wait));
        server.signal(SIGKILL);
        is_killed = true;
      });
      while (!is_killed) {
        const Array<double> value = trace.in();
        ASSERT_TRUE(value.empty() || value[0] == value[value.size() - 1]);
      }
      killer.join();
      EXPECT_TRUE(eventually([&] { return !level.is_open() && !trace.is_open(); }));
    }
    // One that was passed, and whose answer did not come, goes with the connection.
    EXPECT_TRUE(eventually([] { return mappings().empty(); }));
  }
}

TEST_F(WireSlots, AReaderThatIsStoppedHoldsUpNobody) {
  serve(options());
  auto level = connect(options())->level().connect();
  object_->trace().set_in(trace_of(10, 1));
  Child reader(words({"read", url()}), RR_SHARED_MEMORY_PEER);
  reader.wait_for("reading");
  reader.stop();
  for (int i = 1; i <= 2000; ++i) {
    object_->level().set_in(i);
    object_->trace().set_in(trace_of(static_cast<std::size_t>(i), i));
    ASSERT_EQ(level.in(), i);
  }
  auto late = connect(options())->trace().connect();
  EXPECT_EQ(late.in().size(), 2000U);
  for (int i = 1; i <= 50; ++i) {
    object_->trace().set_in(trace_of(large, i));
    ASSERT_TRUE(eventually([&] { return late.in().size() == large && late.in()[0] == i; })) << i;
  }
  object_->trace().set_in(trace_of(2000, 2000));
  reader.signal(SIGCONT);
  reader.wait_for("at 2000");
}

TEST_F(WireSlots, AServiceThatIsStoppedHasItsLastValueRead) {
  Child server(words({"publish"}), RR_SHARED_MEMORY_PEER);
  Node client(options());
  auto wired = client.connect<WiredStub>(server.wait_for("ready"));
  auto level = wired->level().connect();
  auto trace = wired->trace().connect();
  ASSERT_TRUE(trace.wait_in(plenty));
  for (int round = 0; round < 20; ++round) {
    server.stop();
    const double last = level.in();
    for (int i = 0; i < 100; ++i) {
      EXPECT_EQ(level.in(), last);
      const Array<double> value = trace.in();
      ASSERT_TRUE(value.empty() || value[0] == value[value.size() - 1]);
    }
    server.signal(SIGCONT);
    EXPECT_TRUE(eventually([&] { return level.in() > last; }));
  }
}

// Both sides are in this process: each reader finds what a lying service could have written.
// Nothing but the connection may come to harm.
TEST_F(WireSlots, MayBeWrittenOverByTheService) {
  serve(options());
  std::mt19937_64 random(51);
  int broken = 0;
  for (int round = 0; round < 40 / slowness(); ++round) {
    {
      Node client(options());
      auto wired = client.connect<WiredStub>(url());
      auto level = wired->level().connect();
      auto trace = wired->trace().connect();
      const Subscription subscription =
          level.on_in([&](double /*value*/, const TimeSpec& /*time*/) {});
      std::vector<SecondMapping> memories;
      for (const Mapping& mapping : mappings()) {
        if (mapping.kind != 2 || !mapping.is_writable) continue;
        SecondMapping second(mapping);
        ASSERT_TRUE(second.is_there());
        memories.push_back(std::move(second));
      }
      ASSERT_EQ(memories.size(), 2U);
      std::atomic<bool> is_over{false};
      std::thread writer([&, seed = random()] {
        std::mt19937_64 chance(seed);
        while (!is_over) {
          memories[chance() % memories.size()].scribble(chance);
          if (chance() % 4 == 0) std::this_thread::yield();
        }
      });
      for (int i = 0; i < 3000 && level.is_open(); ++i) {
        object_->level().set_in(i);
        object_->trace().set_in(trace_of(static_cast<std::size_t>(i % 500), i));
        (void)level.try_in();
        (void)trace.try_in();
      }
      if (!level.is_open()) ++broken;
      is_over = true;
      writer.join();
    }
    ASSERT_TRUE(eventually([] { return mappings().empty(); })) << mappings().size();
  }
  EXPECT_NE(broken, 0);
}

}  // namespace
}  // namespace rr::testing
