// SPDX-License-Identifier: Apache-2.0
// A site with a mosquitto of its own, which a bridge connects to that of the fleet: the robot's
// gateway is at the one, the serving gateway at the other. With the configuration of
// examples/fleet.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "gateway/testing/mosquitto_broker.hpp"
#include "gateway/testing/rig.hpp"
#include "gateway/topics.hpp"
#include "rr/locks.hpp"

namespace rr::gateway {
namespace {

using std::chrono::milliseconds;
using testing::comes_true;
using testing::Kept;
using testing::MosquittoBroker;
using testing::Rig;
using testing::value_comes;

std::string example(const std::string& name) {
  std::ostringstream text;
  text << std::ifstream(std::string(ROBDEF_FLEET_EXAMPLE) + "/" + name).rdbuf();
  return text.str();
}

/// The example for a broker of this machine, without TLS.
std::string bridge_to(const std::string& address) {
  const std::string text =
      std::regex_replace(example("bridge.conf"), std::regex("bridge_cafile .*\n"), "");
  return std::regex_replace(text, std::regex("fleet\\.example:8883"), address);
}

class Bridges : public ::testing::Test {
 protected:
  void SetUp() override {
    if (MosquittoBroker::program().empty()) GTEST_SKIP() << "mosquitto is not installed";
    fleet.configure({.users = {{"hall", "secret"}, {"hub", "open"}},
                     .access_list = example("bridge.acl") + "user hub\ntopic readwrite #\n"});
    fleet.start();
    const std::string url = fleet.url(false);
    site.configure({.more = bridge_to(url.substr(url.find("//") + 2))});
    site.start();
    rig.emplace(
        [this] {
          const bool is_robots = std::exchange(is_first, false);
          if (is_robots) return make_carriers({.url = site.url(false)});
          return make_carriers({.url = fleet.url(false), .user = "hub", .password = "open"});
        },
        milliseconds(20'000),
        "[[service.user]]\nbroker = \"hub\"\nservice = \"operator\"\npassword_file = \"secret\"\n"
        "[[service.allow]]\nmembers = [\"*\"]\naccess = [\"lock\"]\n");
  }

  MosquittoBroker fleet;
  MosquittoBroker site;
  bool is_first = true;  // of the rig's gateways that of the robot is
  std::optional<Rig> rig;
};

TEST_F(Bridges, CarryAllKindsOfMembers) {
  const auto bench = rig->connect();
  bench->set("speed", 0.75);
  EXPECT_EQ(bench->get("speed").as<double>(), 0.75);
  EXPECT_EQ(bench->call("add", {1.5, 2}).as<double>(), 3.5);
  EXPECT_EQ(bench->object("tools", "left hand").get("width").as<double>(), 2.5);

  auto force = bench->wire("force").connect();
  rig->robot.bench().wire("force").set_in(3.5);
  EXPECT_TRUE(value_comes(force, 3.5));
  bench->wire("target").poke_out(-1.5);
  EXPECT_TRUE(comes_true([&] {
    const auto value = rig->robot.bench().wire("target").out();
    return value && value->value.as<double>() == -1.5;
  }));

  Kept<std::string> stopped;
  const auto subscription = bench->on_event(
      "stopped", [&](const dynamic::List& arguments) { stopped.add(arguments[0].text()); });
  ASSERT_TRUE(comes_true([&] {
    rig->robot.bench().fire("stopped", {"end", 4});
    return stopped.size() > 0;
  }));
  EXPECT_EQ(stopped.items()[0], "end");

  auto commands = bench->pipe("commands").connect();
  commands.send("go");
  EXPECT_TRUE(rig->robot.commands.wait_for(1));

  auto counting = bench->generate("count_to", {2});
  std::vector<double> got;
  while (const auto value = counting.next()) got.push_back(value->as<double>());
  EXPECT_THAT(got, ::testing::ElementsAre(1, 2));

  const auto other = rig->connect();
  lock(bench->stub(), LockOwner::session);
  EXPECT_THROW(static_cast<void>(other->get("speed")), Error);
  unlock(bench->stub());
  EXPECT_EQ(other->get("speed").as<double>(), 0.75);
}

// What the robot has sent meanwhile is asked for again, from the robot's disk.
TEST_F(Bridges, LoseNothingWhileTheFleetsBrokerIsAway) {
  const auto bench = rig->connect();
  auto samples = bench->pipe("samples").connect();
  std::vector<int> got;
  const auto receive = [&] {
    while (const auto packet = samples.try_receive()) got.push_back(packet->as<int>());
  };
  int sent = 0;
  ASSERT_TRUE(comes_true([&] {
    rig->robot.bench().pipe("samples").send(sent++);
    receive();
    return !got.empty();
  }));
  fleet.kill();
  for (int i = 0; i < 500; ++i) rig->robot.bench().pipe("samples").send(sent++);
  fleet.start();
  EXPECT_TRUE(comes_true([&] {
    receive();
    return !got.empty() && got.back() == sent - 1;
  }));
  for (std::size_t i = 1; i < got.size(); ++i) ASSERT_EQ(got[i], got[i - 1] + 1);
  EXPECT_EQ(bench->call("add", {1.5, 2}).as<double>(), 3.5);
}

TEST(BridgeFile, HasAllRequests) {
  std::string requests;
  for (const Verb verb : all_verbs) {
    requests += "topic rr/hall/+/+/$" + std::string(verb_name(verb)) + "/# in 1\n";
  }
  EXPECT_THAT(example("bridge.conf"), ::testing::HasSubstr(requests));
}

}  // namespace
}  // namespace rr::gateway
