// SPDX-License-Identifier: Apache-2.0
// Wires whose values come through slots in shared memory: what readers get, and how memories come
// and go.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "rr/tap.hpp"
#include "runtime/cpp/src/node/testing/guarded.hpp"
#include "runtime/cpp/src/node/testing/process_state.hpp"
#include "runtime/cpp/src/node/testing/wire_slots_rig.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""ms;

TEST_F(WireSlots, AValueIsThereWhenItHasBeenSet) {
  serve(options());
  auto level = connect(options())->level().connect();
  EXPECT_EQ(published(), 1U);
  EXPECT_EQ(read_here(), 1U);
  EXPECT_FALSE(level.try_in());
  for (int i = 1; i <= 1000; ++i) {
    object_->level().set_in(i);
    ASSERT_EQ(level.in(), i);
  }
  const ServedWire<double> served = object_->level().connections().at(0);
  EXPECT_EQ(served.in()->value, 1000);
  EXPECT_EQ(level.try_in()->time, served.in()->time);
}

TEST_F(WireSlots, TheLastValueIsThereWhenAClientConnects) {
  serve(options());
  object_->level().set_in(1.5);
  auto& wired = connect(options());
  auto level = wired->level().connect();
  EXPECT_EQ(level.in(), 1.5);
  EXPECT_EQ(object_->level().connections().at(0).in()->value, 1.5);
  auto other = connect(options())->level().connect();
  EXPECT_EQ(other.in(), 1.5);
  EXPECT_EQ(other.try_in()->time, level.try_in()->time);
}

TEST_F(WireSlots, AllReadersShareOneMemory) {
  serve(options());
  std::vector<WireConnection<double>> wires;
  for (int i = 0; i < 8; ++i) wires.push_back(connect(options())->level().connect());
  EXPECT_EQ(published(), 1U);
  EXPECT_EQ(read_here(), 8U);
  object_->level().set_in(2.5);
  for (const auto& wire : wires) EXPECT_EQ(wire.in(), 2.5);
  for (auto& wire : wires) wire.close();
  EXPECT_TRUE(eventually([] { return published() == 0 && read_here() == 0; }));
  EXPECT_EQ(object_->level().connection_count(), 0U);
}

TEST_F(WireSlots, AreNotUsedWhereOneSideDoesNotShareMemory) {
  serve(options());
  auto& other = connect(options(false));
  auto level = other->level().connect();
  object_->level().set_in(3.5);
  ASSERT_TRUE(level.wait_in(plenty));
  EXPECT_EQ(level.in(), 3.5);
  EXPECT_TRUE(mappings().empty());
}

// What a tap records has to come by messages.
TEST_F(WireSlots, AreNotUsedByANodeWithATap) {
  NodeOptions tapped = options();
  tapped.tap = std::make_shared<Recorder>(run_ + ".rrtape");
  serve(options());
  auto level = connect(tapped)->level().connect();
  object_->level().set_in(3.5);
  ASSERT_TRUE(level.wait_in(plenty));
  EXPECT_EQ(published(), 0U);
  EXPECT_EQ(mappings().size(), 2U) << "the rings";
}

TEST_F(WireSlots, AFunctionIsCalledWithEachValueThatItHasTimeFor) {
  serve(options());
  auto level = connect(options())->level().connect();
  std::atomic<double> last{0};
  std::atomic<bool> is_older{false};
  const Subscription subscription = level.on_in([&](double value, const TimeSpec& /*time*/) {
    if (value <= last.exchange(value)) is_older = true;
  });
  for (int i = 1; i <= 100; ++i) {
    object_->level().set_in(i);
    ASSERT_TRUE(eventually([&] { return last == i; })) << i;
  }
  EXPECT_FALSE(is_older);
  EXPECT_EQ(read_here(), 1U);
}

TEST_F(WireSlots, AFunctionMayCloseItsWire) {
  serve(options());
  auto level = connect(options())->level().connect();
  std::atomic<int> closed{0};
  level.on_closed([&] { ++closed; });
  const Subscription subscription =
      level.on_in([&](double /*value*/, const TimeSpec& /*time*/) { level.close(); });
  object_->level().set_in(1);
  EXPECT_TRUE(eventually([&] { return closed == 1; }));
  EXPECT_TRUE(eventually([] { return mappings().size() == 2; }));
}

TEST_F(WireSlots, AThreadWaitsForAValue) {
  serve(options());
  auto level = connect(options())->level().connect();
  EXPECT_FALSE(level.wait_in(10ms));
  std::thread setter([&] {
    std::this_thread::sleep_for(10ms);
    object_->level().set_in(4.5);
  });
  EXPECT_TRUE(level.wait_in(plenty));
  EXPECT_EQ(level.in(), 4.5);
  setter.join();
}

TEST_F(WireSlots, AWireThatIsClosedEndsAWait) {
  serve(options());
  auto& wired = connect(options());
  auto level = wired->level().connect();
  std::thread closer([&] {
    std::this_thread::sleep_for(10ms);
    wired->close_level();
  });
  EXPECT_FALSE(level.wait_in(plenty));
  EXPECT_FALSE(level.is_open());
  closer.join();
  EXPECT_TRUE(eventually([] { return published() == 0 && read_here() == 0; }));
  auto again = wired->level().connect();
  object_->level().set_in(5.5);
  EXPECT_EQ(again.in(), 5.5);
}

// Each has one more item, and none is followed by a smaller one.
TEST_F(WireSlots, LargerValuesMakeLargerSlots) {
  serve(options());
  auto trace = connect(options())->trace().connect();
  std::vector<std::uint64_t> ids = published_ids();
  std::size_t last = 0;
  for (const std::size_t size : {10U, 1'000U, 100'000U, 400'000U, 1'200'000U}) {
    object_->trace().set_in(trace_of(size, static_cast<double>(size)));
    ASSERT_TRUE(eventually([&] {
      const auto value = trace.try_in();
      if (!value) return false;
      EXPECT_GE(value->value.size(), last);
      last = value->value.size();
      return last == size;
    })) << size;
    EXPECT_EQ(trace.in()[size - 1], size);
    ASSERT_TRUE(eventually([] { return published() == 1 && read_here() == 1; }));
  }
  object_->trace().set_in(trace_of(1'200'001, 7));
  EXPECT_TRUE(eventually([&] { return trace.in().size() == 1'200'001U; }));
  EXPECT_NE(published_ids(), ids);
}

// So are all that follow.
TEST_F(WireSlots, AValueTooLargeForASlotIsAMessage) {
  NodeOptions large = options();
  large.limits.message_size = 100'000'000;
  serve(large);
  auto trace = connect(large)->trace().connect();
  object_->trace().set_in(trace_of(3'000'000, 1));
  ASSERT_TRUE(trace.wait_in(plenty));
  EXPECT_EQ(trace.in().size(), 3'000'000U) << "by a message";
  EXPECT_TRUE(eventually([] { return published() == 0; }));
  object_->trace().set_in(trace_of(5, 2));
  EXPECT_TRUE(eventually([&] { return trace.in().size() == 5; }));
}

// Whether the items are in a memory that this process has mapped to read.
bool is_in_slot(const Array<double>& trace) {
  const auto place = reinterpret_cast<std::uintptr_t>(trace.data());
  const std::vector<Mapping> all = mappings();
  return std::ranges::any_of(all, [&](const Mapping& mapping) {
    const auto begin = reinterpret_cast<std::uintptr_t>(mapping.begin);
    return mapping.kind == 2 && !mapping.is_writable && place >= begin &&
           place < begin + mapping.size;
  });
}
bool are_all(const Array<double>& trace, double number) {
  return std::ranges::all_of(trace, [&](double item) { return item == number; });
}

TEST_F(WireSlots, LargeArraysAreReadInTheirSlotAndStayThere) {
  serve(options());
  auto trace = connect(options())->trace().connect();
  object_->trace().set_in(trace_of(large, 1));
  ASSERT_TRUE(trace.wait_in(plenty));
  ASSERT_TRUE(eventually([&] { return is_in_slot(trace.in()); })) << "the first one is a message";
  const Array<double> first = trace.in();
  for (int i = 2; i <= 50; ++i) {
    object_->trace().set_in(trace_of(large, i));
    ASSERT_TRUE(eventually([&] { return trace.in()[0] == i; })) << i;
    ASSERT_TRUE(are_all(first, 1)) << i;
  }
  EXPECT_TRUE(is_in_slot(trace.in()));
  Array<double> changed = first;
  changed.mutate()[0] = 7;
  EXPECT_FALSE(is_in_slot(changed));
  EXPECT_EQ(first[0], 1);
}

// Those that keep more than two get copies; those that keep all slots together get messages.
TEST_F(WireSlots, ValuesThatAreKeptKeepNoOthersAway) {
  serve(options());
  object_->trace().set_in(trace_of(large, 0));
  std::vector<WireConnection<Array<double>>> traces;
  for (int i = 0; i < 4; ++i) traces.push_back(connect(options())->trace().connect());
  std::vector<std::pair<double, Array<double>>> kept;
  for (int i = 1; i <= 40; ++i) {
    object_->trace().set_in(trace_of(large, i));
    auto& trace = traces[static_cast<std::size_t>(i) % traces.size()];
    ASSERT_TRUE(eventually([&] { return trace.in()[0] == i; })) << i;
    kept.emplace_back(i, trace.in());
  }
  for (auto& trace : traces) EXPECT_TRUE(eventually([&] { return trace.in()[0] == 40; }));
  for (const auto& [number, array] : kept) EXPECT_TRUE(are_all(array, number)) << number;
  EXPECT_EQ(published(), 1U);
  kept.clear();
  object_->trace().set_in(trace_of(large, 41));
  for (auto& trace : traces) {
    EXPECT_TRUE(eventually([&] { return trace.in()[0] == 41 && is_in_slot(trace.in()); }));
  }
}

TEST_F(WireSlots, AnArrayOutlivesItsServiceAndItsNode) {
  serve(options());
  object_->trace().set_in(trace_of(large, 3));
  auto trace = connect(options())->trace().connect();
  Array<double> kept = trace.in();
  ASSERT_TRUE(is_in_slot(kept));
  trace.close();
  auto again = clients_.back().client->trace().connect();
  ASSERT_TRUE(eventually([&] { return again.in()[0] == 3; }));
  again.close();
  clients_.clear();
  server_.reset();
  EXPECT_TRUE(are_all(kept, 3));
  kept = {};
}

// Values for one client are messages. Whichever way is faster, none gets an older value.
TEST_F(WireSlots, ValuesForOneAndForAllKeepTheirOrder) {
  serve(options());
  auto one = connect(options())->level().connect();
  auto other = connect(options())->level().connect();
  double last = 0;
  double last_of_other = 0;
  std::atomic<bool> is_over{false};
  std::thread setter([&] {
    double value = 0;
    std::vector<ServedWire<double>> served = object_->level().connections();
    while (!is_over) {
      object_->level().set_in(++value);
      served.at(0).set_in(++value);
    }
  });
  // On a busy machine that thread begins late.
  EXPECT_TRUE(eventually([&] { return one.try_in() && other.try_in(); }));
  for (int i = 0; i < 20'000 / slowness(); ++i) {
    const double now = one.try_in().value_or(Timed<double>{}).value;
    ASSERT_GE(now, last);
    last = now;
    const double now_of_other = other.try_in().value_or(Timed<double>{}).value;
    ASSERT_GE(now_of_other, last_of_other);
    last_of_other = now_of_other;
  }
  is_over = true;
  setter.join();
  const auto served = object_->level().connections();
  // On a busy machine the first value may come now.
  const auto has_newest = [&](auto& end, std::size_t number) {
    const auto value = end.try_in();
    return value && value->value == served.at(number).in()->value;
  };
  EXPECT_TRUE(eventually([&] { return has_newest(one, 0); }));
  EXPECT_TRUE(eventually([&] { return has_newest(other, 1); }));
}

// A value that nobody has looked at gets old, too.
TEST_F(WireSlots, AValueExpiresFromWhenItWasPublished) {
  serve(options());
  auto level = connect(options())->level().connect();
  level.set_lifespan(50ms);
  object_->level().set_in(1);
  std::this_thread::sleep_for(100ms);
  EXPECT_FALSE(level.try_in());
  level.set_lifespan(std::chrono::hours(1));
  EXPECT_EQ(level.in(), 1);
}

TEST_F(WireSlots, ClientsSendByMessages) {
  serve(options());
  auto level = connect(options())->level().connect();
  level.set_out(6.5);
  EXPECT_TRUE(eventually([&] { return object_->level().out().has_value(); }));
  EXPECT_EQ(object_->level().out()->value, 6.5);
  auto target = clients_.back().client->target().connect();
  target.set_out(7.5);
  EXPECT_TRUE(eventually([&] { return object_->target().out().has_value(); }));
  EXPECT_EQ(published(), 1U) << "nothing is published on a wire that clients write only";
}

// Objects below the root are the same one here, by many paths.
TEST_F(WireSlots, BeyondTheLimitOfASessionValuesAreMessages) {
  constexpr int limit = 64;
  serve(options());
  auto& wired = connect(options());
  std::vector<WireConnection<double>> wires;
  for (int i = 0; i < limit + 3; ++i) {
    wires.push_back(wired->get_child("c" + std::to_string(i))->level().connect());
  }
  EXPECT_EQ(read_here(), std::size_t{limit});
  EXPECT_EQ(published(), 1U);
  object_->child->level().set_in(8.5);
  for (const auto& wire : wires) {
    ASSERT_TRUE(wire.wait_in(plenty));
    EXPECT_EQ(wire.in(), 8.5);
  }
  wires.front().close();
  auto next = wired->get_child("next")->level().connect();
  EXPECT_TRUE(eventually([] { return read_here() == limit; }));
}

// A quarter of the threads may sleep.
TEST_F(WireSlots, BeyondTheLimitOfThreadsValuesAreMessages) {
  serve(options());
  NodeOptions few = options();
  few.max_threads = 4;
  auto& wired = connect(few);
  std::vector<WireConnection<double>> wires;
  std::vector<Subscription> subscriptions;
  std::atomic<int> called{0};
  for (int i = 0; i < 3; ++i) {
    wires.push_back(wired->get_child("c" + std::to_string(i))->level().connect());
    subscriptions.push_back(
        wires.back().on_in([&](double /*value*/, const TimeSpec& /*time*/) { ++called; }));
  }
  EXPECT_TRUE(eventually([] { return read_here() == 1; }));
  object_->child->level().set_in(9.5);
  EXPECT_TRUE(eventually([&] { return called >= 3; }));
  for (const auto& wire : wires) EXPECT_EQ(wire.in(), 9.5);
}

// Rights

ConnectOptions as_user(const std::string& name) {
  ConnectOptions options;
  options.username = name;
  options.credentials["password"] = VarValue(name);
  return options;
}

ServiceOptions with_rules(const std::string& rules) {
  return {.users = std::make_shared<KnownUsers>(), .rights = std::make_shared<Rights>(rules)};
}

// Whoever has left has the old memory still, and must not see what is published afterwards.
TEST_F(WireSlots, WhoeverLeavesAServiceWithUsersLeavesTheMemoryBehind) {
  serve(options(), with_rules("allow user:* path wired.** access *\n"));
  auto alice = connect(options(), as_user("alice"))->level().connect();
  auto bob = connect(options(), as_user("bob"))->level().connect();
  object_->level().set_in(1);
  EXPECT_EQ(alice.in(), 1);
  EXPECT_EQ(bob.in(), 1);
  const auto before = published_ids();
  ASSERT_EQ(before.size(), 1U);
  bob.close();
  object_->level().set_in(2);
  EXPECT_TRUE(eventually([&] { return alice.in() == 2; }));
  EXPECT_TRUE(eventually([] { return published() == 1 && read_here() == 1; }));
  EXPECT_NE(published_ids(), before);
  object_->level().set_in(3);
  EXPECT_TRUE(eventually([&] { return alice.in() == 3; }));
}

TEST_F(WireSlots, WhoeverLosesTheRightIsDisconnected) {
  serve(options(), with_rules("allow user:* path wired.** access *\n"));
  auto alice = connect(options(), as_user("alice"))->level().connect();
  auto bob = connect(options(), as_user("bob"))->level().connect();
  object_->level().set_in(1);
  EXPECT_EQ(bob.in(), 1);
  const auto before = published_ids();
  service_->set_rights(std::make_shared<Rights>("allow user:alice path wired.** access *\n"));
  EXPECT_TRUE(eventually([&] { return !bob.is_open(); }));
  object_->level().set_in(2);
  EXPECT_TRUE(eventually([&] { return alice.in() == 2; }));
  EXPECT_EQ(bob.try_in()->value, 1);
  EXPECT_TRUE(eventually([] { return published() == 1 && read_here() == 1; }));
  EXPECT_NE(published_ids(), before);
}

// Rules where there were none: whoever has left before is not to read on.
TEST_F(WireSlots, NewRulesMakeNewMemories) {
  serve(options());
  auto one = connect(options())->level().connect();
  object_->level().set_in(1);
  EXPECT_EQ(one.in(), 1);
  const auto before = published_ids();
  service_->set_rights(std::make_shared<Rights>("allow anyone path wired.** access *\n"));
  object_->level().set_in(2);
  EXPECT_TRUE(eventually([&] { return one.in() == 2; }));
  EXPECT_TRUE(eventually([&] { return published() == 1 && read_here() == 1; }));
  EXPECT_NE(published_ids(), before);
}

}  // namespace
}  // namespace rr::testing
