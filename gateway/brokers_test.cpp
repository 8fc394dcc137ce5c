// SPDX-License-Identifier: Apache-2.0
// The same as gateways_test.cpp over real brokers, which are killed meanwhile.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <future>
#include <memory>
#include <string>
#include <thread>

#include "gateway/properties.hpp"
#include "gateway/testing/broker_kinds.hpp"
#include "gateway/testing/listener.hpp"
#include "gateway/testing/rig.hpp"

namespace rr::gateway {
namespace {

using std::chrono::milliseconds;
using testing::comes_true;
using testing::Folder;
using testing::Kept;
using testing::Listener;
using testing::OverBroker;
using testing::Program;
using testing::RealBroker;
using testing::Rig;
using testing::value_comes;

class Brokers : public OverBroker {
 protected:
  void SetUp() override {
    OverBroker::SetUp();
    if (!IsSkipped()) broker = GetParam().start();
  }
  Rig& make_rig() {
    return rig.emplace([this] { return make_carriers({broker->url()}); });
  }
  /// An export file of the robot, all of whose members may be read and called.
  [[nodiscard]] std::string write_export(const Folder& folder,
                                         const testing::BenchService& robot) const {
    std::ofstream(folder.path() + "/login") << "open sesame\n";
    const std::string path = folder.path() + "/robot.toml";
    std::ofstream(path) << "site = \"hall\"\nnode = \"robot\"\nstate = \"state\"\n[broker]\n"
                        << "url = \"" << broker->url() << "\"\n[[service]]\nname = \"bench\"\n"
                        << "url = \"" << robot.url() << "\"\nlogin = \"gateway\"\n"
                        << "password_file = \"login\"\nreaders = [\"hub\"]\n"
                        << "[[service.allow]]\nmembers = [\"*\"]\naccess = [\"read\", \"call\"]\n";
    return path;
  }
  void restart() {
    broker->kill();
    std::this_thread::sleep_for(milliseconds(200));
    broker->start();
  }

  std::unique_ptr<RealBroker> broker;
  std::optional<Rig> rig;
};

TEST_P(Brokers, CarriesMessagesAsTheyAre) {
  Listener one;
  Listener two;
  const auto from = make_carrier({broker->url()});
  const auto to = make_carrier({broker->url()});
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
  EXPECT_EQ(got.find("bad"), GetParam().unusual_value);
  EXPECT_EQ(got.find("empty"), "");
  EXPECT_EQ(got.response_topic, message.response_topic);
  EXPECT_EQ(got.correlation, message.correlation);
  from->stop({});
  to->stop({});
}

TEST_P(Brokers, TakesNoMoreThanTheBrokerAcknowledges) {
  Listener listener;
  const auto carrier = GetParam().narrow_carrier({broker->url()}, 10);
  carrier->start(listener, {"life", {}});
  ASSERT_TRUE(listener.connected.wait_for(1));
  int taken = 0;
  while (carrier->publish({"a", Bytes(1'000)}) == Published::taken && taken < 1'000'000) ++taken;
  EXPECT_GE(taken, 10);
  EXPECT_TRUE(listener.rooms.wait_for(1));
  EXPECT_TRUE(comes_true([&] { return carrier->publish({"a", {}}) == Published::taken; }));
  carrier->stop({});
}

TEST_P(Brokers, PublishesTheFarewellAndNotTheWill) {
  Listener one;
  Listener two;
  const auto from = make_carrier({broker->url()});
  const auto to = make_carrier({broker->url()});
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

TEST_P(Brokers, ConnectsAgain) {
  Listener listener;
  const auto carrier = make_carrier({broker->url()});
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

TEST_P(Brokers, SaysWhyItIsRefused) {
  const auto strict = GetParam().start({.users = {{"eve", "right"}}});
  Listener listener;
  const auto carrier = make_carrier({strict->url(), "eve", "wrong"});
  carrier->start(listener, {"life", {}});
  EXPECT_TRUE(comes_true([&] {
    const auto reasons = listener.reasons.items();
    return !reasons.empty() && reasons.back().find(GetParam().refused_user) != std::string::npos;
  })) << (listener.reasons.size() ? listener.reasons.items().back() : "nothing");
  EXPECT_EQ(listener.connected.size(), 0U);
  EXPECT_EQ(carrier->publish({"a", {}}), Published::later);
  carrier->stop({});
}

TEST_P(Brokers, WrongUrlsAreRefused) {
  for (const char* rest : {"", "a:0", "a:70000", "a:x", "a@b", "a/b"}) {
    const std::string url = GetParam().scheme + "://" + rest;
    EXPECT_THROW(static_cast<void>(make_carrier({url})), Error) << url;
  }
}

TEST_P(Brokers, MembersWorkThroughBothGateways) {
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
TEST_P(Brokers, NothingIsLostWhenTheBrokerIsKilled) {
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

TEST_P(Brokers, WiresHaveTheNewestValueAfterTheBrokerWasKilled) {
  Rig& all = make_rig();
  const auto bench = all.connect();
  auto force = bench->wire("force").connect();
  const auto newest_is = [&](double wanted) { return value_comes(force, wanted); };
  all.robot.bench().wire("force").set_in(1);
  ASSERT_TRUE(newest_is(1));
  broker->kill();
  all.robot.bench().wire("force").set_in(2);
  broker->start();
  EXPECT_TRUE(newest_is(2));
}

/// A serving gateway, and a client of it.
struct FarBench {
  explicit FarBench(const RealBroker& broker) : carriers(make_carriers({broker.url()})) {
    const std::string url =
        "rr+tcp://localhost:" + std::to_string(server_node.listen_tcp(0)) + "/?service=far";
    ServerOptions options;
    options.services = {{{"hall", "robot", "bench"}, "far"}};
    options.reader = "hub";
    server.emplace(options, server_node, carriers, [](LogLevel, const std::string&) {});
    EXPECT_TRUE(comes_true([&] {
      try {
        bench = dynamic::connect(client_node, url);
        return true;
      } catch (const Error&) {
        return false;
      }
    }));
  }

  Node server_node;
  Carriers carriers;
  std::optional<Server> server;
  Node client_node;
  dynamic::Client bench;
};

// The programs themselves; the one beside the robot is killed.
TEST_P(Brokers, TheProgramGoesOnAfterItWasKilled) {
  const testing::BenchService robot;
  const Folder folder;
  const std::string path = write_export(folder, robot);
  Listener life;
  const auto watcher = make_carrier({broker->url()});
  watcher->subscribe("rr/hall/robot/$life");
  watcher->start(life, {"other", {}});
  const auto newest_life = [&] {
    const auto all = life.messages.items();
    return all.empty() ? std::string() : text_of(all.back().payload);
  };
  std::optional<Program> gateway;
  gateway.emplace(std::vector<std::string>{ROBDEF_GATEWAY, path});
  ASSERT_TRUE(comes_true([&] { return newest_life() == "up"; }));

  FarBench far(*broker);
  const auto& bench = far.bench;
  EXPECT_EQ(bench->call("count").as<int>(), 1);
  gateway->end(SIGKILL);
  EXPECT_TRUE(comes_true([&] { return newest_life() == "lost"; }));
  gateway.emplace(std::vector<std::string>{ROBDEF_GATEWAY, path});
  EXPECT_EQ(bench->call("count").as<int>(), 2);
  EXPECT_TRUE(testing::exited_with(gateway->end(SIGTERM), 0));
  EXPECT_TRUE(comes_true([&] { return newest_life() == "ended"; }));
  watcher->stop({});
}

// The broker is started again with another password of the serving gateway.
TEST_P(Brokers, ACallSaysThatTheBrokerRefusesTheGateway) {
  const auto strict = GetParam().start({.users = {{"robot", "one"}, {"hub", "two"}}});
  int made = 0;
  Rig all(
      [&] {
        return ++made == 1 ? make_carriers({strict->url(), "robot", "one"})
                           : make_carriers({strict->url(), "hub", "two"});
      },
      milliseconds(1'000));
  const auto bench = all.connect();
  EXPECT_EQ(bench->call("count").as<int>(), 1);
  strict->kill();
  strict->configure({.users = {{"robot", "one"}, {"hub", "three"}}});
  strict->start();
  std::string text;
  EXPECT_TRUE(comes_true([&] {
    try {
      static_cast<void>(bench->get("speed"));
    } catch (const Error& error) {
      text = error.message();
    }
    return text.find("no connection to the broker: " + strict->url() +
                     ": the broker refuses user `hub` or the password: " +
                     GetParam().refused_user) != std::string::npos;
  })) << text;
}

// A limit of the process on the size of files stands for a disk that is full.
TEST_P(Brokers, AFullDiskLosesPacketsAsAGapAndRefusesCalls) {
  const testing::BenchService robot;
  const Folder folder;
  const std::string path = write_export(folder, robot);
  // Of dash in blocks of 512 bytes, of bash in kilobytes: some hundred records at most.
  Program gateway(
      {"sh", "-c", "trap '' XFSZ; ulimit -f 16; exec \"$0\" \"$1\"", ROBDEF_GATEWAY, path});
  FarBench far(*broker);
  const auto& bench = far.bench;
  auto samples = bench->pipe("samples").connect();
  ASSERT_TRUE(comes_true([&] {
    robot.bench().pipe("samples").send(1);
    return samples.try_receive().has_value();
  }));
  for (int i = 0; i < 1'000; ++i) robot.bench().pipe("samples").send(2);
  EXPECT_TRUE(comes_true([&] {
    // What was logged has arrived, and one more shows the gap.
    robot.bench().pipe("samples").send(3);
    return !samples.is_open();
  }));
  int calls = 0;
  std::optional<Error> refused;
  while (!refused && calls < 1'000) {
    try {
      EXPECT_EQ(bench->call("count").as<int>(), calls + 1);
      ++calls;
    } catch (const Error& error) {
      refused = error;
    }
  }
  ASSERT_TRUE(refused.has_value());
  EXPECT_EQ(refused->code(), ErrorCode::io_error);
  EXPECT_THAT(refused->message(), ::testing::HasSubstr("cannot be written: "));
  EXPECT_EQ(robot.counted(), calls);
  EXPECT_EQ(bench->get("speed").as<double>(), 0.5);
  EXPECT_TRUE(testing::exited_with(gateway.end(SIGTERM), 0));
}

TEST_P(Brokers, ASecondProgramForARobotEnds) {
  const testing::BenchService robot;
  const Folder one;
  const Folder two;
  Listener life;
  const auto watcher = make_carrier({broker->url()});
  watcher->subscribe("rr/hall/robot/$life");
  watcher->start(life, {"other", {}});
  Program first({ROBDEF_GATEWAY, write_export(one, robot)});
  ASSERT_TRUE(life.messages.wait_for(1));
  Program second({ROBDEF_GATEWAY, write_export(two, robot)});
  EXPECT_TRUE(testing::exited_with(second.wait(), 1));
  EXPECT_TRUE(first.is_running());
  EXPECT_EQ(text_of(life.messages.items().back().payload), "up");
  EXPECT_TRUE(testing::exited_with(first.end(SIGTERM), 0));
  watcher->stop({});
}

INSTANTIATE_TEST_SUITE_P(All, Brokers, ::testing::ValuesIn(testing::broker_kinds()),
                         testing::name_of_kind);

}  // namespace
}  // namespace rr::gateway
