// SPDX-License-Identifier: Apache-2.0
// What a robot closes while it is connected, through both gateways.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <thread>

#include "gateway/properties.hpp"
#include "gateway/testing/memory_broker.hpp"
#include "gateway/testing/rig.hpp"

namespace rr::gateway {
namespace {

using testing::comes_true;
using testing::Kept;
using testing::MemoryBroker;
using testing::Rig;
using testing::value_comes;

class FarClosings : public ::testing::Test {
 protected:
  [[nodiscard]] std::string told() {
    const auto message = broker.retained("rr/hall/robot/bench/$closed");
    return message ? text_of(message->payload) : "";
  }

  MemoryBroker broker{5};
  Rig rig{[this] { return broker.carriers(); }};
};

TEST_F(FarClosings, OfAWireReachItsClients) {
  const auto client = rig.connect();
  auto force = client->wire("force").connect();
  rig.robot.bench().wire("force").set_in(1.5);
  ASSERT_TRUE(value_comes(force, 1.5));
  for (auto& end : rig.robot.bench().wire("force").connections()) end.close();
  EXPECT_TRUE(comes_true([&] { return !force.is_open(); }));
  EXPECT_EQ(told(), "1\n1 - force\n");
  auto again = client->wire("force").connect();
  rig.robot.bench().wire("force").set_in(2.5);
  EXPECT_TRUE(value_comes(again, 2.5));
  EXPECT_TRUE(again.is_open());
}

TEST_F(FarClosings, OfAnEndpointReachItsClients) {
  const auto client = rig.connect();
  auto samples = client->pipe("samples").connect();
  const auto& pipe = rig.robot.bench().pipe("samples");
  ASSERT_TRUE(comes_true([&] { return pipe.endpoint_count() == 1; }));
  pipe.send(1);
  dynamic::Value packet;
  ASSERT_TRUE(comes_true([&] { return samples.available() == 1; }));
  for (auto& end : pipe.endpoints()) end.close();
  ASSERT_TRUE(comes_true([&] { return !samples.is_open(); }));
  auto again = client->pipe("samples").connect();
  ASSERT_TRUE(comes_true([&] { return pipe.endpoint_count() == 1; }));
  pipe.send(2);
  ASSERT_TRUE(comes_true([&] { return again.available() == 1; }));
  EXPECT_EQ(again.receive().as<int>(), 2);
}

TEST_F(FarClosings, OfAnObjectReachItsClients) {
  Kept<std::string> released;
  ConnectOptions options;
  options.on_path_released = [&](const std::string& path) { released.add(path); };
  const auto client = rig.connect(options);
  const auto tool = client->object("tools", "left hand");
  auto grip = tool.wire("grip").connect();
  Kept<int> opened;
  auto subscription = tool.on_event(
      "opened", [&](const dynamic::List& arguments) { opened.add(arguments[0].as<int>()); });
  rig.robot.tool().wire("grip").set_in(1.5);
  ASSERT_TRUE(value_comes(grip, 1.5));

  rig.robot.release("tools[left%20hand]");
  ASSERT_TRUE(released.wait_for(1));
  EXPECT_EQ(released.items()[0], "bench.tools[left%20hand]");
  EXPECT_TRUE(comes_true([&] { return !grip.is_open(); }));
  EXPECT_EQ(told(), "1\n1 tools[left%20hand]\n");
  // Streams and wires of the object that is there now arrive.
  const auto found = client->object("tools", "left hand");
  EXPECT_EQ(found.get("width").as<double>(), 2.5);
  auto again = found.wire("grip").connect();
  rig.robot.tool().wire("grip").set_in(2.5);
  EXPECT_TRUE(value_comes(again, 2.5));
  subscription = Subscription();
  const auto anew = found.on_event(
      "opened", [&](const dynamic::List& arguments) { opened.add(arguments[0].as<int>()); });
  EXPECT_TRUE(comes_true([&] {
    found.call("open", {});
    return !opened.items().empty();
  }));
  // Each event once: the gateway listens to one object alone.
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const std::size_t before = opened.items().size();
  found.call("open", {});
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_EQ(opened.items().size(), before + 1);
}

// It may come back, and with it all that was connected.
TEST_F(FarClosings, AreNotMeantByALostRobot) {
  const auto client = rig.connect();
  auto force = client->wire("force").connect();
  rig.robot.bench().wire("force").set_in(1.5);
  ASSERT_TRUE(value_comes(force, 1.5));
  rig.robot.close();
  EXPECT_TRUE(comes_true([&] {
    const auto life = broker.retained("rr/hall/robot/bench/$life");
    return life && text_of(life->payload) == "down";
  }));
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  EXPECT_EQ(told(), "0\n");
  EXPECT_TRUE(force.is_open());
}

TEST_F(FarClosings, AttributesTravel) {
  const auto client = rig.connect();
  EXPECT_EQ(client.attributes().at("place").text(), "bench 4");
}

}  // namespace
}  // namespace rr::gateway
