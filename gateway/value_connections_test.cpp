// SPDX-License-Identifier: Apache-2.0
// Wires and all others over the two connections of each gateway, one of which is held or lost.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <thread>

#include "gateway/properties.hpp"
#include "gateway/testing/listener.hpp"
#include "gateway/testing/memory_broker.hpp"
#include "gateway/testing/rig.hpp"

namespace rr::gateway {
namespace {

using std::chrono::milliseconds;
using testing::comes_true;
using testing::Folder;
using testing::Kept;
using testing::Listener;
using testing::MemoryBroker;
using testing::Rig;
using testing::Traffic;
using testing::value_comes;

const std::string force_topic = "rr/hall/robot/bench/force";
const std::string life_topic = "rr/hall/robot/$life";
/// Too short for a value to be published again by itself.
constexpr const char* short_life =
    "[[service.allow]]\nmembers = [\"force\"]\naccess = [\"read\"]\nlifespan = \"1 s\"\n";

/// A connection of the test that keeps what it hears.
struct Peer {
  Peer(MemoryBroker& broker, Traffic traffic, const std::string& filter)
      : carrier(broker.carrier(traffic)) {
    carrier->subscribe(filter);
    carrier->start(listener, {});
    EXPECT_TRUE(listener.connected.wait_for(1));
  }
  ~Peer() { carrier->stop({}); }

  Listener listener;
  std::unique_ptr<Carrier> carrier;
};

class GatewayValues : public ::testing::Test {
 protected:
  void SetUp() override {
    bench = rig.connect();
    force = bench->wire("force").connect();
    set(1);
    ASSERT_TRUE(value_comes(force, 1));
  }
  void set(double value) { rig.robot.bench().wire("force").set_in(value); }
  [[nodiscard]] std::size_t published() const { return broker.published(force_topic); }
  /// Of the value that the broker retains.
  [[nodiscard]] std::string number() const {
    const auto value = broker.retained(force_topic);
    return value ? std::string(value->find("number").value_or("none")) : "no value";
  }

  MemoryBroker broker{5};
  Rig rig{[this] { return broker.carriers(); }, milliseconds(20'000), short_life};
  dynamic::Client bench;
  dynamic::WireConnection force;
};

TEST_F(GatewayValues, ArriveWhileMessagesAreHeld) {
  broker.hold(Traffic::messages, true);
  for (int i = 2; i <= 20; ++i) {
    set(i);
    ASSERT_TRUE(value_comes(force, i));
  }
  broker.hold(Traffic::messages, false);
  EXPECT_EQ(bench->call("count").as<int>(), 1);
}

TEST_F(GatewayValues, ArriveWithoutTheConnectionForMessages) {
  broker.set_links(Traffic::messages, false);
  set(2);
  EXPECT_TRUE(value_comes(force, 2));
  broker.set_links(Traffic::messages, true);
  EXPECT_EQ(bench->call("count").as<int>(), 1);
  set(3);
  EXPECT_TRUE(value_comes(force, 3));
}

TEST_F(GatewayValues, OthersGoOnWhileTheyAreHeld) {
  auto samples = bench->pipe("samples").connect();
  ASSERT_TRUE(comes_true([&] {
    rig.robot.bench().pipe("samples").send(1);
    return samples.try_receive().has_value();
  }));
  broker.hold(Traffic::values, true);
  set(2);
  EXPECT_EQ(bench->call("count").as<int>(), 1);
  rig.robot.bench().pipe("samples").send(2);
  EXPECT_TRUE(comes_true([&] {
    const auto packet = samples.try_receive();
    return packet && packet->as<int>() == 2;
  }));
  // Of the values that were sent meanwhile only the newest travels.
  const std::size_t before = published();
  for (int i = 3; i <= 50; ++i) set(i);
  EXPECT_EQ(bench->call("count").as<int>(), 2);
  EXPECT_EQ(published(), before);
  broker.hold(Traffic::values, false);
  EXPECT_TRUE(value_comes(force, 50));
  // The last ones may still have been on their way to the gateway.
  EXPECT_LE(published(), before + 10);
}

TEST_F(GatewayValues, OthersGoOnWithoutTheirConnection) {
  broker.set_links(Traffic::values, false);
  set(2);
  EXPECT_EQ(bench->call("count").as<int>(), 1);
  Kept<int> codes;
  const auto subscription = bench->on_event(
      "stopped", [&](const dynamic::List& arguments) { codes.add(arguments[1].as<int>()); });
  ASSERT_TRUE(comes_true([&] {
    rig.robot.bench().fire("stopped", {"end", 4});
    return codes.size() > 0;
  }));
  EXPECT_EQ(bench->wire("force").peek_in().value.as<double>(), 2);
  broker.set_links(Traffic::values, true);
  EXPECT_TRUE(value_comes(force, 2));
}

TEST_F(GatewayValues, ArePublishedAgainWhenOnlyTheirConnectionWasLost) {
  const std::size_t lives = broker.published(life_topic);
  const std::size_t before = published();
  const std::string newest = number();
  broker.set_links(Traffic::values, false);
  std::this_thread::sleep_for(milliseconds(50));
  EXPECT_EQ(published(), before);
  broker.set_links(Traffic::values, true);
  EXPECT_TRUE(comes_true([&] { return published() == before + 1; }));
  EXPECT_EQ(broker.published(life_topic), lives);
  // The same value, which clients do not get again.
  EXPECT_EQ(number(), newest);
  set(2);
  EXPECT_TRUE(value_comes(force, 2));
}

TEST_F(GatewayValues, ArePublishedAgainAfterTheBrokerWasKilled) {
  const std::string newest = number();
  broker.crash();
  EXPECT_EQ(number(), "no value");
  broker.restart();
  EXPECT_TRUE(comes_true([&] { return number() == newest; })) << number();
}

TEST_F(GatewayValues, AnOlderOneIsNotTakenAfterANewerOne) {
  Kept<double> got;
  const auto subscription = force.on_in(
      [&](const dynamic::Value& value, const TimeSpec&) { got.add(value.as<double>()); });
  Message old = *broker.retained(force_topic);
  old.retained = false;
  set(2);
  ASSERT_TRUE(value_comes(force, 2));
  Peer peer(broker, Traffic::values, life_topic);
  ASSERT_EQ(peer.carrier->publish(old), Published::taken);
  set(3);
  ASSERT_TRUE(value_comes(force, 3));
  // What the gateway before has left on its way.
  rig.stop_export();
  rig.start_export();
  ASSERT_TRUE(comes_true([&] {
    const auto life = broker.retained("rr/hall/robot/bench/$life");
    return life && text_of(life->payload) == "up";
  }));
  ASSERT_TRUE(comes_true([&] {
    set(4);
    return broker.retained(force_topic)->find("stream") != old.find("stream");
  }));
  ASSERT_TRUE(value_comes(force, 4));
  for (auto& [name, value] : old.properties) value = name == "number" ? "1000" : value;
  ASSERT_EQ(peer.carrier->publish(old), Published::taken);
  set(5);
  ASSERT_TRUE(value_comes(force, 5));
  ASSERT_TRUE(comes_true([&] { return got.size() > 0 && got.items().back() == 5; }));
  const auto items = got.items();
  EXPECT_TRUE(std::ranges::is_sorted(items)) << ::testing::PrintToString(items);
}

TEST_F(GatewayValues, AreNotThoseOfAGatewayThatIsRefused) {
  Peer reader(broker, Traffic::values, force_topic);
  ASSERT_TRUE(reader.listener.messages.wait_for(1));
  const Folder state;
  const Carriers carriers = broker.carriers();
  Kept<std::string> refused;
  const Exporter second(
      rig.export_file(state.path()), carriers, [](LogLevel, const std::string&) {},
      [&](const std::string& reason) { refused.add(reason); });
  double value = 1;
  ASSERT_TRUE(comes_true([&] {
    set(++value);
    return refused.size() > 0 && rig.robot.bench().wire("force").connection_count() >= 2;
  }));
  for (int i = 0; i < 20; ++i) {
    set(++value);
    std::this_thread::sleep_for(milliseconds(10));
  }
  ASSERT_TRUE(value_comes(force, value));
  std::set<std::string> streams;
  for (const Message& message : reader.listener.messages.items()) {
    streams.insert(std::string(message.find("stream").value_or("none")));
  }
  EXPECT_EQ(streams.size(), 1U);
}

TEST_F(GatewayValues, EndWhenAnotherGatewayTakesTheNodeMeanwhile) {
  broker.set_links(Traffic::messages, false);
  set(2);
  ASSERT_TRUE(value_comes(force, 2));
  // Its connection for values hears of it, and after that of the next value.
  Peer other(broker, Traffic::values, life_topic);
  ASSERT_TRUE(other.listener.messages.wait_for(1));
  Message life{life_topic, bytes_of("up")};
  life.properties = {{"instance", "other"}, {"started", "1"}, {"host", "other"}};
  life.retained = true;
  ASSERT_EQ(other.carrier->publish(life), Published::taken);
  ASSERT_TRUE(other.listener.messages.wait_for(2));
  double value = 2;
  EXPECT_TRUE(comes_true([&] {
    const std::size_t before = published();
    set(++value);
    std::this_thread::sleep_for(milliseconds(500));
    return published() == before;
  }));
  // It is not there when it is asked, so the node and its values are this gateway's again.
  broker.set_links(Traffic::messages, true);
  EXPECT_TRUE(value_comes(force, value));
}

}  // namespace
}  // namespace rr::gateway
