// SPDX-License-Identifier: Apache-2.0
// Client, serving gateway, broker in memory, exporting gateway, robot.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <string>
#include <thread>

#include "gateway/properties.hpp"
#include "gateway/testing/listener.hpp"
#include "gateway/testing/memory_broker.hpp"
#include "gateway/testing/rig.hpp"

namespace rr::gateway {
namespace {

using std::chrono::milliseconds;
using testing::code_of;
using testing::comes_true;
using testing::Faults;
using testing::Kept;
using testing::MemoryBroker;
using testing::Rig;
using testing::value_comes;

class Gateways : public ::testing::Test {
 protected:
  MemoryBroker broker{7};
  Rig rig{[this] { return broker.carriers(); }};
};

TEST_F(Gateways, PropertiesAreGotAndSet) {
  const auto bench = rig.connect();
  EXPECT_EQ(bench->get("speed").as<double>(), 0.5);
  bench->set("speed", 0.75);
  EXPECT_EQ(bench->get("speed").as<double>(), 0.75);
  EXPECT_EQ(rig.robot.bench().stored("speed").as<double>(), 0.75);
  EXPECT_EQ(bench->get("pose")["q"].at(1).as<double>(), 2.0);
  bench->set("mode", "fast");
  EXPECT_EQ(bench->get("mode").text(), "fast");
}

TEST_F(Gateways, FunctionsAreCalled) {
  const auto bench = rig.connect();
  EXPECT_EQ(bench->call("add", {1.5, 2}).as<double>(), 3.5);
  const auto pose = dynamic::Value::record({{"x", 4}, {"q", dynamic::List{}}});
  EXPECT_EQ(bench->call("describe", {"arm", pose}).text(), "arm at 4.000000");
}

TEST_F(Gateways, ErrorsOfTheRobotArriveAsTheyAre) {
  const auto bench = rig.connect();
  try {
    bench->call("fail", {"stuck"});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::remote_error);
    EXPECT_EQ(error.name(), "test.bench.Jam");
    EXPECT_EQ(error.message(), "stuck");
  }
}

TEST_F(Gateways, WhatIsNotExportedIsDenied) {
  const auto bench = rig.connect();
  std::string text;
  EXPECT_EQ(code_of([&] { return bench->get("secret"); }, &text), ErrorCode::permission_denied);
  EXPECT_THAT(text, ::testing::HasSubstr("does not allow hub to get `secret`"));
  EXPECT_EQ(code_of([&] { bench->set("secret", 1); }), ErrorCode::permission_denied);
  EXPECT_EQ(rig.robot.bench().stored("secret").as<int>(), 7);
}

TEST_F(Gateways, EventsArrive) {
  const auto bench = rig.connect();
  Kept<std::string> got;
  const auto subscription = bench->on_event("stopped", [&](const dynamic::List& arguments) {
    got.add(arguments[0].text() + std::to_string(arguments[1].as<int>()));
  });
  ASSERT_TRUE(comes_true([&] {
    rig.robot.bench().fire("stopped", {"end", 4});
    return got.size() > 0;
  }));
  EXPECT_EQ(got.items()[0], "end4");
}

/// Looks at the robot in the moment in which its service is announced.
struct LifeReader final : CarrierHandler {
  explicit LifeReader(Function<void()> when_up) : on_up(std::move(when_up)) {}
  void on_message(Message message) override {
    if (text_of(message.payload) == "up") on_up();
  }
  void on_connected() override {}
  void on_disconnected(const std::string&) override {}
  void on_room() override {}
  void on_refused(const Refusal&) override {}
  Function<void()> on_up;
};

TEST_F(Gateways, AServiceIsUpWhenItsStreamsAreConnected) {
  rig.stop_export();
  ASSERT_TRUE(comes_true([&] { return rig.robot.bench().pipe("samples").endpoint_count() == 0; }));
  broker.crash();  // an announcement that is retained is an old one
  broker.restart();
  Kept<std::size_t> connected;
  LifeReader reader([&] {
    connected.add(rig.robot.bench().pipe("samples").endpoint_count() +
                  rig.robot.bench().wire("force").connection_count());
  });
  const auto carrier = broker.carrier();
  carrier->subscribe("rr/hall/robot/bench/$life");
  carrier->start(reader, {});
  rig.start_export();
  ASSERT_TRUE(connected.wait_for(1));
  EXPECT_EQ(connected.items()[0], 2U);
  carrier->stop({});
}

TEST_F(Gateways, AChangeOfTheServiceIsInTheLogOfTheServingGateway) {
  static_cast<void>(rig.connect());
  const auto is_logged = [&](const std::string& wanted) {
    return comes_true([&] {
      const auto lines = rig.log.items();
      return std::ranges::any_of(lines, [&](const auto& line) { return line.starts_with(wanted); });
    });
  };
  EXPECT_TRUE(is_logged("rr/hall/robot/bench is up"));
  rig.robot.close();
  EXPECT_TRUE(is_logged("rr/hall/robot/bench is down: "));
}

TEST_F(Gateways, WiresHaveTheNewestValue) {
  const auto bench = rig.connect();
  auto force = bench->wire("force").connect();
  rig.robot.bench().wire("force").set_in(3.5);
  ASSERT_TRUE(comes_true([&] {
    const auto value = force.try_in();
    return value && value->value.as<double>() == 3.5;
  }));
  for (int i = 0; i < 1'000; ++i) rig.robot.bench().wire("force").set_in(i);
  EXPECT_TRUE(comes_true([&] { return force.in().as<double>() == 999; }));
  EXPECT_EQ(bench->wire("force").peek_in().value.as<double>(), 999);
  const auto retained = broker.retained("rr/hall/robot/bench/force");
  ASSERT_TRUE(retained.has_value());
  EXPECT_EQ(retained->find("type"), "double");
  EXPECT_EQ(retained->payload.size(), 19U);
}

TEST_F(Gateways, PeeksAskTheRobot) {
  const auto bench = rig.connect();
  rig.robot.bench().wire("force").on_peek_in([] { return dynamic::Value(8.5); });
  EXPECT_EQ(bench->wire("force").peek_in().value.as<double>(), 8.5);
  rig.robot.bench().wire("target").on_peek_out([] { return dynamic::Value(-1.5); });
  EXPECT_EQ(bench->wire("target").peek_out().value.as<double>(), -1.5);
}

TEST_F(Gateways, AWireHasItsNewestValueWhenTheLinkIsUpAgain) {
  const auto bench = rig.connect();
  auto force = bench->wire("force").connect();
  const auto newest = [&] {
    const auto value = force.try_in();
    return value ? value->value.as<double>() : -1;
  };
  rig.robot.bench().wire("force").set_in(1);
  ASSERT_TRUE(comes_true([&] { return newest() == 1; }));
  broker.set_links(false);
  for (int i = 2; i <= 50; ++i) rig.robot.bench().wire("force").set_in(i);
  const std::size_t before = broker.published("rr/hall/robot/bench/force");
  EXPECT_EQ(newest(), 1);
  broker.set_links(true);
  EXPECT_TRUE(comes_true([&] { return newest() == 50; }));
  // The older values have not travelled. The last ones may still have been on their way to the
  // gateway when the link came up.
  EXPECT_LE(broker.published("rr/hall/robot/bench/force"), before + 10);
}

TEST_F(Gateways, AWireHasItsNewestValueAfterTheServingGatewayWasRestarted) {
  const auto newest_is = [&](double wanted) {
    const auto bench = rig.connect();
    auto force = bench->wire("force").connect();
    return comes_true([&] {
      const auto value = force.try_in();
      return value && value->value.as<double>() == wanted;
    });
  };
  rig.robot.bench().wire("force").set_in(4);
  ASSERT_TRUE(newest_is(4));
  rig.stop_server();
  rig.start_server();
  EXPECT_TRUE(newest_is(4));
  rig.stop_server();
  rig.robot.bench().wire("force").set_in(5);
  rig.start_server();
  EXPECT_TRUE(newest_is(5));
}

// As a broker does to a reader that is slow: without a word to either side.
TEST_F(Gateways, AWireHasItsNewestValueAfterTheBrokerHasDroppedIt) {
  const auto bench = rig.connect();
  auto force = bench->wire("force").connect();
  const auto newest_is = [&](double wanted) { return value_comes(force, wanted); };
  rig.robot.bench().wire("force").set_in(1);
  ASSERT_TRUE(newest_is(1));
  broker.set_faults({.dropped = 1});
  rig.robot.bench().wire("force").set_in(2);
  std::this_thread::sleep_for(milliseconds(300));
  broker.set_faults({});
  EXPECT_TRUE(newest_is(2));
}

TEST(GatewayWires, AreHeldToTheirRate) {
  MemoryBroker broker;
  Rig rig([&] { return broker.carriers(); }, milliseconds(20'000),
          "[[service.allow]]\nmembers = [\"force\"]\naccess = [\"read\"]\nrate = \"5/s\"\n"
          "lifespan = \"7 s\"\n");
  const auto bench = rig.connect();
  auto force = bench->wire("force").connect();
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i <= 100; ++i) {
    rig.robot.bench().wire("force").set_in(i);
    std::this_thread::sleep_for(milliseconds(5));
  }
  EXPECT_TRUE(comes_true([&] {
    const auto value = force.try_in();
    return value && value->value.as<double>() == 100;
  }));
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
  EXPECT_LE(broker.published("rr/hall/robot/bench/force"), 5 * time.count() + 2);
  // Less when it was published once more already.
  const auto expiry = broker.retained("rr/hall/robot/bench/force")->expiry;
  ASSERT_TRUE(expiry.has_value());
  EXPECT_LE(*expiry, std::chrono::seconds(7));
  EXPECT_GE(*expiry, std::chrono::seconds(1));
}

TEST_F(Gateways, ValuesForWiresReachTheRobot) {
  const auto bench = rig.connect();
  bench->wire("target").poke_out(2.5);
  EXPECT_TRUE(comes_true([&] {
    const auto value = rig.robot.bench().wire("target").out();
    return value && value->value.as<double>() == 2.5;
  }));
}

TEST_F(Gateways, ObjectsBelowTheRootAreReached) {
  const auto bench = rig.connect();
  const auto tool = bench->object("tools", "left hand");
  EXPECT_EQ(tool.type_name(), "test.bench.Tool");
  EXPECT_EQ(tool.get("width").as<double>(), 2.5);
  Kept<int> opened;
  const auto subscription = tool.on_event(
      "opened", [&](const dynamic::List& arguments) { opened.add(arguments[0].as<int>()); });
  ASSERT_TRUE(comes_true([&] {
    tool.call("open");
    return opened.size() > 0;
  }));
  EXPECT_NE(code_of([&] { return bench->object("tools", "right").get("width"); }), ErrorCode::none);
}

TEST_F(Gateways, PacketsArriveOnceAndInOrderThroughABadBroker) {
  const auto bench = rig.connect();
  auto samples = bench->pipe("samples").connect();
  Kept<std::uint32_t> got;
  const auto subscription =
      samples.on_packet([&](const dynamic::Value& packet) { got.add(packet.as<std::uint32_t>()); });
  ASSERT_TRUE(comes_true([&] {
    rig.robot.bench().pipe("samples").send(0);
    return got.size() > 0;
  }));
  const std::size_t before = got.size();
  broker.set_faults({.dropped = 0.2, .twice = 0.2, .delay = milliseconds(10)});
  for (std::uint32_t i = 1; i <= 2'000; ++i) {
    rig.robot.bench().pipe("samples").send(i);
    if (i == 700) broker.cut();
    if (i == 1'400) {
      broker.crash();
      broker.restart();
    }
  }
  // Those that were sent until the first arrived are zeros, too.
  ASSERT_TRUE(comes_true([&] { return !got.items().empty() && got.items().back() == 2'000; }));
  const auto items = got.items();
  std::uint32_t expected = 0;
  for (std::size_t i = before; i < items.size(); ++i) {
    if (items[i] == 0 && expected == 0) continue;
    ASSERT_EQ(items[i], ++expected);
  }
  EXPECT_EQ(expected, 2'000U);
  EXPECT_TRUE(samples.is_open());
}

TEST_F(Gateways, ACallIsExecutedOnceThoughEverythingIsRepeated) {
  const auto bench = rig.connect();
  broker.set_faults({.dropped = 0.3, .twice = 0.5, .delay = milliseconds(5)});
  for (int i = 1; i <= 40; ++i) EXPECT_EQ(bench->call("count").as<int>(), i);
  EXPECT_EQ(rig.robot.counted(), 40);
  EXPECT_GT(broker.published("rr/hall/robot/bench/$call/#"), 40U);
}

TEST_F(Gateways, ACallWaitsForTheBroker) {
  const auto bench = rig.connect();
  broker.crash();
  std::jthread later([&] {
    std::this_thread::sleep_for(milliseconds(200));
    broker.restart();
  });
  EXPECT_EQ(bench->call("count").as<int>(), 1);
  later.join();
  EXPECT_EQ(rig.robot.counted(), 1);
}

TEST_F(Gateways, TheExportingGatewayIsRestarted) {
  const auto bench = rig.connect();
  EXPECT_EQ(bench->call("count").as<int>(), 1);
  auto samples = bench->pipe("samples").connect();
  ASSERT_TRUE(comes_true([&] {
    rig.robot.bench().pipe("samples").send(1);
    return samples.try_receive().has_value();
  }));
  rig.stop_export();
  EXPECT_TRUE(comes_true([&] {
    const auto life = broker.retained("rr/hall/robot/$life");
    return life && life->payload.size() == 5;  // "ended"
  }));
  rig.start_export();
  EXPECT_EQ(bench->call("count").as<int>(), 2);
  EXPECT_EQ(bench->get("speed").as<double>(), 0.5);
  // What the robot has sent meanwhile is lost: the client is told by the end of its endpoint.
  EXPECT_TRUE(comes_true([&] { return !samples.is_open(); }));
  samples = bench->pipe("samples").connect();
  EXPECT_TRUE(comes_true([&] {
    rig.robot.bench().pipe("samples").send(2);
    const auto packet = samples.try_receive();
    return packet && packet->as<int>() == 2;
  }));
}

// Handlers of the robot's events, and requests that are executed, use nothing that has ended: they
// crash, or wait for ever, or sanitizers find them.
TEST_F(Gateways, TheExportingGatewayEndsWhileRequestsAreExecuted) {
  std::atomic<bool> ends{false};
  const auto repeat = [&](const Function<void()>& action) {
    return std::async(std::launch::async, [&ends, action] {
      while (!ends) {
        action();
        std::this_thread::sleep_for(std::chrono::microseconds(20));
      }
    });
  };
  const auto bench = rig.connect();
  const auto tool = bench->object("tools", "left hand");
  const auto sending = repeat([&] {
    rig.robot.bench().pipe("samples").send(1);
    rig.robot.bench().wire("force").set_in(1);
  });
  std::atomic<int> asked{0};
  const auto asking = repeat([&] {
    if (asked > 50) return;
    ++asked;
    tool.async_get("width", [&](const std::exception_ptr&, const dynamic::Value&) { --asked; });
  });
  for (int i = 0; i < 15; ++i) {
    rig.stop_export();
    rig.start_export();
    EXPECT_TRUE(comes_true([&] {
      return rig.robot.bench().pipe("samples").endpoint_count() == 1 &&
             rig.robot.bench().wire("force").connection_count() == 1;
    })) << i;
    EXPECT_EQ(bench->get("speed").as<double>(), 0.5);
  }
  ends = true;
  asking.wait();
  EXPECT_TRUE(comes_true([&] { return asked == 0; }));
}

TEST_F(Gateways, AnswersGoNowhereElse) {
  rig.connect();
  testing::Listener handler;
  const auto carrier = broker.carrier();
  carrier->start(handler, {});
  ASSERT_TRUE(handler.connected.wait_for(1));
  Message request{"rr/hall/robot/bench/$get/eve/speed", {}};
  request.correlation = Bytes(4);
  request.response_topic = "rr/hall/robot/bench/force";
  ASSERT_EQ(carrier->publish(request), Published::taken);
  request.response_topic = "rr/$reply/eve/1";
  ASSERT_EQ(carrier->publish(request), Published::taken);
  EXPECT_TRUE(comes_true([&] { return broker.published("rr/$reply/eve/1") == 1; }));
  EXPECT_EQ(broker.published("rr/hall/robot/bench/force"), 0U);
  carrier->stop({});
}

/// What the robot's gateway says of a request that no gateway of ours sends.
std::string refusal_of(MemoryBroker& broker, Message request) {
  testing::Listener handler;
  const auto carrier = broker.carrier();
  carrier->subscribe("rr/$reply/eve/1");
  carrier->start(handler, {});
  EXPECT_TRUE(handler.connected.wait_for(1));
  request.correlation = Bytes(4);
  request.response_topic = "rr/$reply/eve/1";
  EXPECT_EQ(carrier->publish(request), Published::taken);
  const bool is_answered = handler.messages.wait_for(1);
  carrier->stop({});
  if (!is_answered) return "no answer";
  return std::string(handler.messages.items()[0].find("error-message").value_or("no error"));
}

TEST_F(Gateways, ARequestHasALimitedNumberOfPackets) {
  rig.connect();
  Message request{"rr/hall/robot/bench/$send/eve/commands", Bytes(10'000)};
  request.properties = {{"count", "257"}};
  EXPECT_EQ(refusal_of(broker, request), "a request has at most 256 packets, this one says 257");
}

TEST_F(Gateways, ARequestReadsALimitedPartOfAMemory) {
  rig.connect();
  Message request{"rr/hall/robot/bench/$get/eve/trace", {}};
  for (const char* const count : {"1048577", "4000000000", "18446744073709551615", "65536,65536"}) {
    request.properties = {{"position", "0"}, {"count", count}};
    EXPECT_EQ(refusal_of(broker, request), "a request reads at most 1048576 items of a memory")
        << count;
  }
}

TEST_F(Gateways, AnAnswerThatIsTooLargeForTheBrokerIsAnError) {
  const auto bench = rig.connect();
  broker.set_faults({.largest = 100});
  const auto pose = dynamic::Value::record({{"x", 4}, {"q", dynamic::List{}}});
  std::string text;
  EXPECT_EQ(code_of([&] { bench->call("fail", {std::string(200, 'x')}); }, &text),
            ErrorCode::buffer_limit_violation);
  EXPECT_THAT(text, ::testing::HasSubstr("the request is too large"));
  rig.robot.bench().store("pose",
                          dynamic::Value::record({{"x", 1}, {"q", std::vector<double>(100)}}));
  EXPECT_EQ(code_of([&] { return bench->get("pose"); }, &text), ErrorCode::buffer_limit_violation);
  EXPECT_THAT(text, ::testing::HasSubstr("the answer is too large"));
}

constexpr const char* hub_is_operator =
    "[[service.user]]\nbroker = \"hub\"\nservice = \"operator\"\npassword_file = \"secret\"\n";

TEST(GatewayUsers, AreThoseOfTheService) {
  MemoryBroker broker;
  Rig rig([&] { return broker.carriers(); }, milliseconds(20'000), hub_is_operator, "open sesame");
  EXPECT_EQ(rig.connect()->call("whoami").text(), "operator");
}

TEST(GatewayUsers, WithoutAnEntryTheyAreTheGateway) {
  MemoryBroker broker;
  Rig rig([&] { return broker.carriers(); });
  EXPECT_EQ(rig.connect()->call("whoami").text(), "gateway");
}

TEST(GatewayUsers, AWrongPasswordIsReported) {
  MemoryBroker broker;
  Rig rig([&] { return broker.carriers(); }, milliseconds(20'000), hub_is_operator, "wrong");
  const auto bench = rig.connect();
  EXPECT_EQ(code_of([&] { return bench->call("whoami"); }), ErrorCode::authentication_error);
}

TEST(GatewayTrouble, ACallThatWasGivenUpIsNotExecutedLater) {
  MemoryBroker broker;
  Rig rig([&] { return broker.carriers(); }, milliseconds(600));
  const auto bench = rig.connect();
  broker.crash();
  EXPECT_EQ(code_of([&] { return bench->call("count"); }), ErrorCode::connection_error);
  broker.restart();
  EXPECT_TRUE(
      comes_true([&] { return code_of([&] { return bench->get("speed"); }) == ErrorCode::none; }));
  EXPECT_EQ(bench->call("count").as<int>(), 1);
  EXPECT_EQ(broker.published("rr/hall/robot/bench/$call/hub/count"), 1U);
}

TEST(GatewayTrouble, ARobotThatIsNotThereIsReportedOnce) {
  MemoryBroker broker;
  const testing::Folder folder;
  Kept<std::string> log;
  ExportFile file;
  file.site = "hall";
  file.node = "robot";
  file.state_folder = folder.path();
  ExportedServiceOptions arm;
  arm.name = "arm";
  arm.url = "rr+tcp://localhost:1/?service=arm";
  file.services.push_back(arm);
  const Carriers carriers = broker.carriers();
  const Exporter exporter(file, carriers,
                          [&](LogLevel, const std::string& text) { log.add(text); });
  const auto reports = [&] {
    const auto lines = log.items();
    return std::ranges::count_if(lines, [](const auto& line) { return line.starts_with("arm: "); });
  };
  EXPECT_TRUE(comes_true([&] { return reports() > 0; }));
  EXPECT_TRUE(comes_true([&] {
    const auto life = broker.retained("rr/hall/robot/arm/$life");
    return life && life->find("reason") &&
           life->find("reason")->find("Connection") != std::string::npos;
  }));
  EXPECT_EQ(reports(), 1);
}

TEST(GatewayTrouble, ErrorsSayWhereItFailed) {
  MemoryBroker broker;
  Rig rig([&] { return broker.carriers(); }, milliseconds(600));
  const auto bench = rig.connect();
  std::string text;
  rig.stop_export();
  EXPECT_EQ(code_of([&] { return bench->get("speed"); }, &text), ErrorCode::connection_error);
  EXPECT_THAT(text,
              ::testing::HasSubstr("the gateway of the robot hall/robot is not at the broker"));
  broker.crash();
  EXPECT_EQ(code_of([&] { return bench->get("speed"); }, &text), ErrorCode::connection_error);
  EXPECT_THAT(text, ::testing::HasSubstr("no connection to the broker"));
}

}  // namespace
}  // namespace rr::gateway
