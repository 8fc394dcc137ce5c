// SPDX-License-Identifier: Apache-2.0
// The same as gateways_test.cpp over a real broker, which is killed meanwhile.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <future>
#include <string>
#include <thread>

#include "gateway/mqtt_carrier.hpp"
#include "gateway/properties.hpp"
#include "gateway/testing/listener.hpp"
#include "gateway/testing/mosquitto_broker.hpp"
#include "gateway/testing/rig.hpp"

namespace rr::gateway {
namespace {

using std::chrono::milliseconds;
using testing::comes_true;
using testing::Folder;
using testing::Kept;
using testing::Listener;
using testing::MosquittoBroker;
using testing::Program;
using testing::Rig;

class Mosquitto : public ::testing::Test {
 protected:
  void SetUp() override {
    if (MosquittoBroker::program().empty()) GTEST_SKIP() << "mosquitto is not installed";
    broker.emplace();
  }
  Rig& make_rig() {
    return rig.emplace([this] { return make_mqtt_carrier({broker->url()}); });
  }
  void restart() {
    broker->kill();
    std::this_thread::sleep_for(milliseconds(200));
    broker->start();
  }

  std::optional<MosquittoBroker> broker;
  std::optional<Rig> rig;
};

TEST_F(Mosquitto, CarriesMessagesAsTheyAre) {
  Listener one;
  Listener two;
  const auto from = make_mqtt_carrier({broker->url()});
  const auto to = make_mqtt_carrier({broker->url()});
  to->subscribe("a/#");
  from->start(one, {"life/one", bytes_of("lost")});
  to->start(two, {"life/two", bytes_of("lost")});
  ASSERT_TRUE(one.connected.wait_for(1));
  ASSERT_TRUE(two.connected.wait_for(1));
  Message message{"a/b", bytes_of(std::string("\0\1\xff", 3))};
  message.properties = {{"type", "double"}, {"bad", "\xff\n"}, {"empty", ""}};
  message.response_topic = "rr/$reply/x/1";
  message.correlation = bytes_of(std::string("\0id", 3));
  ASSERT_EQ(from->publish(message), Published::taken);
  ASSERT_TRUE(two.messages.wait_for(1));
  const Message got = two.messages.items()[0];
  EXPECT_EQ(got.topic, "a/b");
  EXPECT_EQ(got.payload, message.payload);
  EXPECT_EQ(got.find("type"), "double");
  EXPECT_EQ(got.find("bad"), "??");
  EXPECT_EQ(got.find("empty"), "");
  EXPECT_EQ(got.response_topic, message.response_topic);
  EXPECT_EQ(got.correlation, message.correlation);
  from->stop({});
  to->stop({});
}

TEST_F(Mosquitto, TakesNoMoreThanTheBrokerAcknowledges) {
  Listener listener;
  const auto carrier = make_mqtt_carrier({broker->url()}, {.in_flight = 10});
  carrier->start(listener, {"life", {}});
  ASSERT_TRUE(listener.connected.wait_for(1));
  int taken = 0;
  while (carrier->publish({"a", Bytes(1'000)}) == Published::taken && taken < 1'000'000) ++taken;
  EXPECT_GE(taken, 10);
  EXPECT_TRUE(listener.rooms.wait_for(1));
  EXPECT_TRUE(comes_true([&] { return carrier->publish({"a", {}}) == Published::taken; }));
  carrier->stop({});
}

TEST_F(Mosquitto, PublishesTheFarewellAndNotTheWill) {
  Listener one;
  Listener two;
  const auto from = make_mqtt_carrier({broker->url()});
  const auto to = make_mqtt_carrier({broker->url()});
  to->subscribe("life");
  to->start(two, {"other", {}});
  from->start(one, {"life", bytes_of("lost")});
  ASSERT_TRUE(one.connected.wait_for(1));
  ASSERT_TRUE(two.connected.wait_for(1));
  from->stop({"life", bytes_of("ended")});
  ASSERT_TRUE(two.messages.wait_for(1));
  EXPECT_EQ(text_of(two.messages.items()[0].payload), "ended");
  to->stop({});
}

TEST_F(Mosquitto, ConnectsAgain) {
  Listener listener;
  const auto carrier = make_mqtt_carrier({broker->url()});
  carrier->subscribe("a");
  carrier->start(listener, {"life", {}});
  ASSERT_TRUE(listener.connected.wait_for(1));
  restart();
  ASSERT_TRUE(listener.connected.wait_for(2));
  ASSERT_TRUE(listener.reasons.size() >= 1);
  EXPECT_THAT(listener.reasons.items()[0], ::testing::HasSubstr(broker->url()));
  ASSERT_TRUE(comes_true([&] { return carrier->publish({"a", {}}) == Published::taken; }));
  EXPECT_TRUE(listener.messages.wait_for(1));
  carrier->stop({});
}

TEST_F(Mosquitto, SaysWhyItIsRefused) {
  const MosquittoBroker strict("allow_anonymous false\n");
  Listener listener;
  const auto carrier = make_mqtt_carrier({strict.url(), "eve", "wrong"});
  carrier->start(listener, {"life", {}});
  EXPECT_TRUE(comes_true([&] {
    const auto reasons = listener.reasons.items();
    return !reasons.empty() && reasons.back().find("Not authorized") != std::string::npos;
  })) << (listener.reasons.size() ? listener.reasons.items().back() : "nothing");
  EXPECT_EQ(listener.connected.size(), 0U);
  EXPECT_EQ(carrier->publish({"a", {}}), Published::later);
  carrier->stop({});
}

TEST_F(Mosquitto, WrongUrlsAreRefused) {
  for (const char* url :
       {"", "mqtt://", "http://a", "mqtt://a:0", "mqtt://a:70000", "mqtt://a:x"}) {
    EXPECT_THROW(static_cast<void>(make_mqtt_carrier({url})), Error) << url;
  }
}

TEST_F(Mosquitto, MembersWorkThroughBothGateways) {
  Rig& all = make_rig();
  const auto bench = all.connect();
  bench->set("speed", 0.25);
  EXPECT_EQ(bench->get("speed").as<double>(), 0.25);
  EXPECT_EQ(bench->call("add", {1, 2}).as<double>(), 3);
  try {
    bench->call("fail", {"stuck"});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.name(), "test.bench.Jam");
  }
  Kept<int> codes;
  const auto subscription = bench->on_event(
      "stopped", [&](const dynamic::List& arguments) { codes.add(arguments[1].as<int>()); });
  ASSERT_TRUE(comes_true([&] {
    all.robot.bench().fire("stopped", {"end", 4});
    return codes.size() > 0;
  }));
  EXPECT_EQ(codes.items()[0], 4);
}

// 10,000 packets while the broker is killed three times, and its retained messages with it.
TEST_F(Mosquitto, NothingIsLostWhenTheBrokerIsKilled) {
  Rig& all = make_rig();
  const auto bench = all.connect();
  auto samples = bench->pipe("samples").connect();
  Kept<std::uint32_t> got;
  const auto subscription =
      samples.on_packet([&](const dynamic::Value& packet) { got.add(packet.as<std::uint32_t>()); });
  ASSERT_TRUE(comes_true([&] {
    all.robot.bench().pipe("samples").send(0);
    return got.size() > 0;
  }));
  constexpr std::uint32_t count = 10'000;
  std::jthread robot([&] {
    for (std::uint32_t i = 1; i <= count; ++i) {
      all.robot.bench().pipe("samples").send(i);
      if (i % 50 == 0) std::this_thread::sleep_for(milliseconds(10));
    }
  });
  for (std::size_t kill = 1; kill <= 3; ++kill) {
    EXPECT_TRUE(got.wait_for(kill * count / 4));
    restart();
  }
  const int before = all.robot.counted();
  broker->kill();
  auto answer = std::async(std::launch::async, [&] { return bench->call("count").as<int>(); });
  std::this_thread::sleep_for(milliseconds(200));
  broker->start();
  EXPECT_EQ(answer.get(), before + 1);
  robot.join();
  EXPECT_TRUE(comes_true([&] { return got.items().back() == count; }));
  std::uint32_t expected = 0;
  for (const std::uint32_t item : got.items()) {
    if (item == 0 && expected == 0) continue;
    ASSERT_EQ(item, ++expected);
  }
  EXPECT_EQ(expected, count);
  EXPECT_TRUE(samples.is_open());
  EXPECT_EQ(all.robot.counted(), before + 1);
}

TEST_F(Mosquitto, WiresHaveTheNewestValueAfterTheBrokerWasKilled) {
  Rig& all = make_rig();
  const auto bench = all.connect();
  auto force = bench->wire("force").connect();
  const auto newest_is = [&](double wanted) {
    return comes_true([&] {
      const auto value = force.try_in();
      return value && value->value.as<double>() == wanted;
    });
  };
  all.robot.bench().wire("force").set_in(1);
  ASSERT_TRUE(newest_is(1));
  broker->kill();
  all.robot.bench().wire("force").set_in(2);
  broker->start();
  EXPECT_TRUE(newest_is(2));
}

// The programs themselves; the one beside the robot is killed.
TEST_F(Mosquitto, TheProgramGoesOnAfterItWasKilled) {
  const testing::BenchService robot;
  const Folder folder;
  const std::string path = folder.path() + "/robot.toml";
  std::ofstream(path) << "site = \"hall\"\nnode = \"robot\"\nstate = \"state\"\n[broker]\nurl = \""
                      << broker->url() << "\"\n[[service]]\nname = \"bench\"\nurl = \""
                      << robot.url()
                      << "\"\nlogin = \"gateway\"\npassword_file = \"login\"\nreaders = "
                         "[\"hub\"]\n[[service.allow]]\nmembers = [\"*\"]\n"
                         "access = [\"read\", \"call\"]\n";
  std::ofstream(folder.path() + "/login") << "open sesame\n";
  Listener life;
  const auto watcher = make_mqtt_carrier({broker->url()});
  watcher->subscribe("rr/hall/robot/$life");
  watcher->start(life, {"other", {}});
  const auto newest_life = [&] {
    const auto all = life.messages.items();
    return all.empty() ? std::string() : text_of(all.back().payload);
  };
  std::optional<Program> gateway;
  gateway.emplace(std::vector<std::string>{ROBDEF_GATEWAY, path});
  ASSERT_TRUE(comes_true([&] { return newest_life() == "up"; }));

  Node server_node;
  const auto port = server_node.listen_tcp(0);
  const auto carrier = make_mqtt_carrier({broker->url()});
  ServerOptions options;
  options.services = {{{"hall", "robot", "bench"}, "far"}};
  options.reader = "hub";
  const Server server(options, server_node, *carrier, [](LogLevel, const std::string&) {});
  Node client_node;
  dynamic::Client bench;
  ASSERT_TRUE(comes_true([&] {
    try {
      bench = dynamic::connect(client_node,
                               "rr+tcp://localhost:" + std::to_string(port) + "/?service=far");
      return true;
    } catch (const Error&) {
      return false;
    }
  }));
  EXPECT_EQ(bench->call("count").as<int>(), 1);
  gateway->end(SIGKILL);
  EXPECT_TRUE(comes_true([&] { return newest_life() == "lost"; }));
  gateway.emplace(std::vector<std::string>{ROBDEF_GATEWAY, path});
  EXPECT_EQ(bench->call("count").as<int>(), 2);
  EXPECT_TRUE(testing::exited_with(gateway->end(SIGTERM), 0));
  EXPECT_TRUE(comes_true([&] { return newest_life() == "ended"; }));
  watcher->stop({});
}

}  // namespace
}  // namespace rr::gateway
