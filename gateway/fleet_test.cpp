// SPDX-License-Identifier: Apache-2.0
#include "gateway/fleet.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "gateway/fleet_query.hpp"
#include "gateway/properties.hpp"
#include "gateway/testing/memory_broker.hpp"
#include "gateway/testing/rig.hpp"
#include "rr/error.hpp"
#include "rr/version.hpp"

namespace rr::gateway {
namespace {

using std::chrono::milliseconds;
using testing::comes_true;
using ::testing::HasSubstr;
using testing::MemoryBroker;
using testing::Rig;

Message life(const std::string& topic, const std::string& state, Properties properties = {}) {
  return {topic, bytes_of(state), std::move(properties)};
}

TEST(GatewayFleet, IsWrittenForPeople) {
  Fleet fleet;
  EXPECT_EQ(fleet.text(), "no robots\n");
  fleet.take(life("rr/hall/r1/$life", "up",
                  {{"host", "pc"}, {"version", "0.3"}, {"started", "1795779856000000000"}}));
  fleet.take(life("rr/hall/r1/arm/$life", "down", {{"reason", "Connection refused"}}));
  fleet.take({"rr/hall/r1/arm/$streams",
              bytes_of(status_text({{"pose", {120, 3, 20'500, {{"desk", 100}, {"log", 120}}}}}))});
  fleet.take(life("rr/hall/r0/$life", "lost"));
  EXPECT_EQ(fleet.text(),
            "hall/r0: lost\n"
            "hall/r1: up, gateway 0.3 at pc since 2026-11-27T11:44:16Z\n"
            "  arm: down, Connection refused\n"
            "    pose: 120 records, 20 kB on disk, 3 not sent; desk lacks 20; log lacks 0\n");
  const auto json = nlohmann::json::parse(fleet.json());
  EXPECT_EQ(json["hall/r0"]["state"], "lost");
  const auto& arm = json["hall/r1"]["services"]["arm"];
  EXPECT_EQ(arm["reason"], "Connection refused");
  EXPECT_EQ(arm["streams"]["pose"]["last"], 120);
  EXPECT_EQ(arm["streams"]["pose"]["waiting"], 3);
  EXPECT_EQ(arm["streams"]["pose"]["readers"]["desk"]["lag"], 20);
}

TEST(GatewayFleet, WhatIsMalformedIsIgnored) {
  Fleet fleet;
  for (const char* topic : {"rr/hall/$life", "rr/a/b/c/d/$life", "x/hall/r1/$life",
                            "rr/h%ll/r1/$life", "rr/hall/r1/$claim", "rr/hall/r1/arm/$def", ""}) {
    fleet.take(life(topic, "up"));
  }
  EXPECT_EQ(fleet.text(), "no robots\n");
  for (const char* text : {"", "{", "[]", "7", R"({"a":1})", R"({"a":{"last":"x"}})",
                           R"({"a":{"last":1,"readers":{"b":3}}})"}) {
    fleet.take({"rr/hall/r1/arm/$streams", bytes_of(text)});
    EXPECT_THAT(fleet.text(), HasSubstr("hall/r1: unknown\n  arm: unknown\n")) << text;
  }
  // Texts of others do not reach the terminal as they are.
  fleet.take(life("rr/hall/r1/$life", "up\x1b[2J"));
  EXPECT_EQ(fleet.text().find('\x1b'), std::string::npos);
}

TEST(GatewayFleet, IsAskedForAtTheBroker) {
  MemoryBroker broker;
  Rig rig([&] { return broker.carriers(); });
  const auto bench = rig.connect();
  auto samples = bench->pipe("samples").connect();
  ASSERT_TRUE(comes_true([&] {
    rig.robot.bench().pipe("samples").send(1);
    return samples.try_receive().has_value();
  }));
  nlohmann::json robot;
  const auto lag_is = [&](int lag) {
    const auto carrier = broker.carrier();
    const std::string text = ask_for_fleet(*carrier, milliseconds(5'000), milliseconds(50)).json();
    robot = nlohmann::json::parse(text)["hall/robot"];
    const auto& streams = robot["services"]["bench"]["streams"];
    // The numbers of the first seconds may be of a stream that was empty.
    return streams.contains("samples") && streams["samples"]["last"] > 0 &&
           streams["samples"]["readers"]["hub"]["lag"] == lag;
  };
  EXPECT_TRUE(comes_true([&] { return lag_is(0); })) << robot.dump(2);
  EXPECT_EQ(robot["state"], "up");
  EXPECT_EQ(robot["version"], library_version());
  EXPECT_EQ(robot["services"]["bench"]["state"], "up");
  // A reader that is not there lacks what comes.
  rig.stop_server();
  for (int i = 0; i < 10; ++i) rig.robot.bench().pipe("samples").send(2);
  EXPECT_TRUE(comes_true([&] { return lag_is(10); })) << robot.dump(2);
}

TEST(GatewayFleet, ABrokerThatIsNotThereIsAnError) {
  MemoryBroker broker;
  broker.set_links(false);
  const auto carrier = broker.carrier();
  EXPECT_THROW(static_cast<void>(ask_for_fleet(*carrier, milliseconds(100), milliseconds(10))),
               Error);
}

}  // namespace
}  // namespace rr::gateway
