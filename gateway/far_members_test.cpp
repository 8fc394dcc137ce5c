// SPDX-License-Identifier: Apache-2.0
// Members that take several requests, through both gateways: generators, memories, pipes to the
// robot.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "gateway/exported_generators.hpp"
#include "gateway/testing/memory_broker.hpp"
#include "gateway/testing/rig.hpp"

namespace rr::gateway {
namespace {

using std::chrono::milliseconds;
using testing::comes_true;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::MemoryBroker;
using testing::Rig;

constexpr testing::Faults bad_link{.dropped = 0.2, .twice = 0.3, .delay = milliseconds(5)};

template <class Call>
Error error_of_call(Call call) {
  try {
    static_cast<void>(call());
  } catch (const Error& error) {
    return error;
  }
  return {ErrorCode::none, "no error"};
}

class FarGenerators : public ::testing::Test {
 protected:
  MemoryBroker broker{11};
  Rig rig{[this] { return broker.carriers(); }};
  dynamic::Client bench = rig.connect();
};
using FarMemories = FarGenerators;
using FarPipes = FarGenerators;

TEST_F(FarGenerators, GiveValuesUntilTheirEnd) {
  auto steps = bench->generate("count_to", {3});
  std::vector<double> got;
  while (const auto value = steps.next()) got.push_back(value->as<double>());
  EXPECT_THAT(got, ElementsAre(1, 2, 3));
  // Each call has its own.
  auto others = bench->generate("count_to", {9});
  EXPECT_EQ(others.next()->as<double>(), 1);
}

TEST_F(FarGenerators, TakeValues) {
  auto collect = bench->generate("collect");
  EXPECT_TRUE(collect.next(1.5).has_value());
  EXPECT_TRUE(collect.next(2.5).has_value());
  collect.close();
  EXPECT_THAT(rig.robot.collected.items(), ElementsAre(1.5, 2.5));
  ASSERT_TRUE(rig.robot.ended.wait_for(1));
  EXPECT_EQ(rig.robot.ended.items()[0], "closed");
}

TEST_F(FarGenerators, GiveAndTakeValues) {
  auto sums = bench->generate("sums", {10});
  EXPECT_EQ(sums.next(1)->as<double>(), 11);
  EXPECT_EQ(sums.next(2)->as<double>(), 13);
}

TEST_F(FarGenerators, EachStepIsExecutedOnceOverABadLink) {
  broker.set_faults(bad_link);
  auto steps = bench->generate("count_to", {50});
  for (int i = 1; i <= 50; ++i) ASSERT_EQ(steps.next()->as<double>(), i);
  EXPECT_FALSE(steps.next().has_value());
  EXPECT_GT(broker.published("rr/hall/robot/bench/$next/#"), 51U);
}

TEST_F(FarGenerators, AreBrokenOff) {
  auto steps = bench->generate("count_to", {3});
  EXPECT_EQ(steps.next()->as<double>(), 1);
  steps.abort();
  ASSERT_TRUE(rig.robot.ended.wait_for(1));
  EXPECT_EQ(rig.robot.ended.items()[0], "aborted");
}

TEST_F(FarGenerators, ErrorsOfStepsArriveAsTheyAre) {
  auto steps = bench->generate("count_to", {-1});
  const Error error = error_of_call([&] { return steps.next(); });
  EXPECT_EQ(error.name(), "test.bench.Jam");
  EXPECT_EQ(error.message(), "no way down");
}

TEST_F(FarGenerators, EndWithTheGatewayOfTheRobot) {
  auto steps = bench->generate("count_to", {3});
  EXPECT_EQ(steps.next()->as<double>(), 1);
  rig.stop_export();
  rig.start_export();
  const Error error = error_of_call([&] { return steps.next(); });
  EXPECT_EQ(error.code(), ErrorCode::invalid_operation);
  EXPECT_THAT(error.message(), HasSubstr("the robot's gateway has no such generator"));
}

TEST_F(FarGenerators, ThatNobodyUsesAreBrokenOff) {
  using Clock = ExportedGenerators::Clock;
  Node node;
  const auto near = dynamic::connect(node, rig.robot.url(), rig.login());
  ExportedGenerators open;
  const auto begin = Clock::now();
  const ExportedGenerator used{near->generate("count_to", {3}), near.types(),
                               near->member("count_to")};
  const ExportedGenerator left{near->generate("count_to", {3}), near.types(),
                               near->member("count_to")};
  const std::string used_name = open.add("alice", used, begin);
  const std::string left_name = open.add("alice", left, begin);
  EXPECT_FALSE(open.find("bob", used_name, begin));
  EXPECT_TRUE(open.find("alice", used_name, begin + std::chrono::seconds(5)));
  open.end_idle(begin + std::chrono::seconds(10), std::chrono::seconds(10));
  ASSERT_TRUE(rig.robot.ended.wait_for(1));
  EXPECT_EQ(rig.robot.ended.items()[0], "aborted");
  EXPECT_FALSE(open.find("alice", left_name, begin));
  EXPECT_TRUE(open.find("alice", used_name, begin));
}

TEST_F(FarMemories, AreReadAndWritten) {
  const auto trace = bench->memory("trace");
  EXPECT_EQ(trace.length(), 8U);
  EXPECT_EQ(trace.read({2}, {3}).at(1).as<double>(), 3);
  trace.write({6}, std::vector<double>{60, 70});
  const auto all = rig.robot.bench().stored_memory("trace");
  EXPECT_EQ(all.at(5).as<double>(), 5);
  EXPECT_EQ(all.at(6).as<double>(), 60);
  EXPECT_EQ(all.at(7).as<double>(), 70);
}

TEST_F(FarMemories, HaveSeveralDimensions) {
  broker.set_faults(bad_link);
  const auto grid = bench->memory("grid");
  EXPECT_THAT(grid.dims(), ElementsAre(20, 30));
  const auto part = grid.read({2, 3}, {4, 5});
  EXPECT_THAT(part.dims(), ElementsAre(4, 5));
  for (std::uint32_t column = 0; column < 5; ++column) {
    for (std::uint32_t row = 0; row < 4; ++row) {
      EXPECT_EQ(part.at(column * 4 + row).as<unsigned>(), ((3 + column) * 20 + 2 + row) % 251);
    }
  }
}

TEST_F(FarMemories, ThatAreLargeTravelInParts) {
  std::vector<double> items(200'000);
  for (std::size_t i = 0; i < items.size(); ++i) items[i] = static_cast<double>(i);
  rig.robot.bench().store_memory("trace", items);
  const auto all = bench->memory("trace").read({0}, {items.size()});
  EXPECT_EQ(all.at(199'999).as<double>(), 199'999);
  EXPECT_EQ(all.at(100'000).as<double>(), 100'000);
  EXPECT_GT(broker.published("rr/hall/robot/bench/$get/hub/trace"), 10U);
}

TEST_F(FarMemories, MistakesAreErrors) {
  const auto outside = error_of_call([&] { return bench->memory("trace").read({6}, {3}); });
  EXPECT_NE(outside.code(), ErrorCode::none);
  const auto fixed = error_of_call([&] {
    bench->memory("grid").write({0, 0}, bench->memory("grid").read({0, 0}, {1, 1}));
    return 0;
  });
  EXPECT_EQ(fixed.code(), ErrorCode::read_only_member);
}

TEST_F(FarPipes, PacketsReachTheRobotOnceAndInOrderOverABadLink) {
  broker.set_faults(bad_link);
  auto commands = bench->pipe("commands").connect();
  for (int i = 0; i < 500; ++i) {
    commands.send(std::to_string(i));
    if (i == 200) broker.cut();
  }
  commands.close();
  ASSERT_TRUE(rig.robot.commands.wait_for(501)) << rig.robot.commands.items().size() << " arrived\n"
                                                << ::testing::PrintToString(rig.log.items());
  const auto got = rig.robot.commands.items();
  ASSERT_EQ(got.size(), 501U);
  for (std::size_t i = 0; i < 500; ++i) ASSERT_EQ(got[i], std::to_string(i));
  EXPECT_EQ(got[500], "end");
}

TEST_F(FarPipes, EachEndpointHasOneAtTheRobot) {
  auto one = bench->pipe("commands").connect();
  auto two = bench->pipe("commands").connect();
  one.send("one");
  ASSERT_TRUE(rig.robot.commands.wait_for(1));
  two.send("two");
  ASSERT_TRUE(rig.robot.commands.wait_for(2));
  EXPECT_EQ(rig.robot.bench().pipe("commands").endpoint_count(), 2U);
  one.close();
  EXPECT_TRUE(comes_true([&] { return rig.robot.bench().pipe("commands").endpoint_count() == 1; }));
  two.send("three");
  ASSERT_TRUE(rig.robot.commands.wait_for(4));
  EXPECT_THAT(rig.robot.commands.items(), ElementsAre("one", "two", "end", "three"));
}

TEST_F(FarPipes, GoBothWays) {
  auto both = bench->pipe("both").connect();
  both.send(7);
  ASSERT_TRUE(rig.robot.both.wait_for(1));
  EXPECT_EQ(rig.robot.both.items()[0], 7U);
  // Once, though the robot has two endpoints of this gateway.
  rig.robot.bench().pipe("both").send(8);
  rig.robot.bench().pipe("both").send(9);
  std::vector<int> got;
  EXPECT_TRUE(comes_true([&] {
    while (const auto packet = both.try_receive()) got.push_back(packet->as<int>());
    return !got.empty() && got.back() == 9;
  }));
  EXPECT_THAT(got, ElementsAre(8, 9));
}

TEST_F(FarPipes, AnEndpointIsClosedWhenPacketsAreLost) {
  MemoryBroker other_broker;
  Rig other([&] { return other_broker.carriers(); }, milliseconds(600));
  const auto far = other.connect();
  auto commands = far->pipe("commands").connect();
  commands.send("one");
  ASSERT_TRUE(other.robot.commands.wait_for(1));
  other_broker.set_links(false);
  commands.send("two");
  EXPECT_TRUE(comes_true([&] { return !commands.is_open(); }));
  EXPECT_TRUE(comes_true([&] {
    for (const auto& line : other.log.items()) {
      if (line.find("packets for `commands` are lost: ") != std::string::npos) return true;
    }
    return false;
  }));
}

}  // namespace
}  // namespace rr::gateway
