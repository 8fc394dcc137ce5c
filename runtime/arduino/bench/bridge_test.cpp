// SPDX-License-Identifier: Apache-2.0
// Clients over TCP, the bridge, a pseudo terminal, and the real program on a simulated processor.
#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <thread>

#include "rr/dynamic.hpp"
#include "rr/node.hpp"
#include "rr/serial.hpp"
#include "runtime/arduino/bench/elf_dir.hpp"
#include "runtime/arduino/bench/plugged_board.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::serial::testing {
namespace {

using namespace std::chrono_literals;
using dynamic::Fields;
using dynamic::List;
using dynamic::Value;
using rr::testing::error_of;
using rr::testing::eventually;

class Bridged : public ::testing::Test {
 protected:
  void plug(const std::string& elf) {
    board = std::make_unique<PluggedBoard>(elf_dir + elf);
    bridge = std::make_unique<BoardBridge>(server, [this](const std::string& text) {
      const std::lock_guard lock(mutex);
      log.push_back(text);
    });
    bridge->add({.path = board->path()});
    ASSERT_TRUE(bridge->wait(20s));
    port = server.listen_tcp(0, "127.0.0.1");
  }
  [[nodiscard]] dynamic::Client connect(const std::string& name) {
    return dynamic::connect(client_node,
                            "rr+tcp://127.0.0.1:" + std::to_string(port) + "/?service=" + name);
  }
  std::size_t times(const std::string& text) {
    const std::lock_guard lock(mutex);
    return static_cast<std::size_t>(std::count(log.begin(), log.end(), text));
  }

  std::mutex mutex;
  std::vector<std::string> log;
  Node server;
  Node client_node;
  std::unique_ptr<PluggedBoard> board;
  std::unique_ptr<BoardBridge> bridge;
  std::uint16_t port = 0;
};

Value color(float red, float green, float blue) {
  return Value::record({{"red", red}, {"green", green}, {"blue", blue}});
}

TEST_F(Bridged, ALightIsAServiceLikeAnyOther) {
  plug("light.elf");
  board->set_voltage(2.5);
  const dynamic::Client light = connect("Light");
  EXPECT_EQ(light->type_name(), "example.light.Light");
  EXPECT_EQ(light->documentation(), "A lamp of three colours and a light sensor.");
  light->set("color", color(0.7F, 0.3F, 0.1F));
  EXPECT_EQ(light->get("color").at("red").as<float>(), 0.7F);
  EXPECT_EQ(board->peek(0x88), 178);
  EXPECT_NEAR(light->get("brightness").as<double>(), 255.5, 1);
  const Error error = error_of([&] { light->set("color", color(2, 0, 0)); });
  EXPECT_EQ(error.code(), ErrorCode::out_of_range);
  EXPECT_EQ(error_of([&] { light->set("brightness", 1.0); }).code(), ErrorCode::read_only_member);
}

TEST_F(Bridged, EventsAndWiresReachEveryClient) {
  plug("light.elf");
  board->set_voltage(5);
  const dynamic::Client one = connect("Light");
  const dynamic::Client two = connect("Light");
  std::atomic<int> faded = 0;
  const auto count = [&](const List& arguments) {
    if (arguments.at(0).at("green").as<float>() == 0.5F) ++faded;
  };
  const Subscription first = one->on_event("faded", count);
  const Subscription second = two->on_event("faded", count);
  one->call("fade", {color(1, 0.5F, 0), 0.1});
  EXPECT_TRUE(eventually([&] { return faded == 2; }));

  EXPECT_NEAR(two->wire("sensor").peek_in().value.as<double>(), 511.5, 1);
  dynamic::WireConnection wire = two->wire("sensor").connect();
  ASSERT_TRUE(wire.wait_in(20s));
  EXPECT_NEAR(wire.in().as<double>(), 511.5, 1);
}

TEST_F(Bridged, AResetFailsTheCallAndIsMended) {
  plug("echo115200.elf");
  const dynamic::Client echo = connect("Echo");
  EXPECT_EQ(echo->call("add", {20.0, 22.0}).as<double>(), 42);
  std::thread resetter([&] {
    std::this_thread::sleep_for(300ms);
    board->reset();
  });
  const Error error = error_of([&] { echo->call("wait", {std::uint16_t{3000}}); });
  resetter.join();
  EXPECT_EQ(error.code(), ErrorCode::connection_error);
  EXPECT_TRUE(eventually([&] { return times("Echo: connected") == 2; }));
  EXPECT_EQ(echo->get("count").as<std::uint32_t>(), 0U) << "the same client goes on";
  EXPECT_EQ(echo->call("add", {1.0, 2.0}).as<double>(), 3);
}

TEST_F(Bridged, ABoardThatIsSilentIsLostAndFoundAgain) {
  plug("echo115200.elf");
  const dynamic::Client echo = connect("Echo");
  board->set_silent(true);
  EXPECT_TRUE(
      eventually([&] { return times("Echo: lost: it has been reset, or does not answer") == 1; }));
  EXPECT_EQ(error_of([&] { (void)echo->get("value"); }).code(), ErrorCode::connection_error);
  board->set_silent(false);
  EXPECT_TRUE(eventually([&] { return times("Echo: connected") == 2; }));
  EXPECT_EQ(echo->get("value").as<double>(), 0);
}

TEST_F(Bridged, PipesCarryPacketsBothWays) {
  plug("echo115200.elf");
  const dynamic::Client echo = connect("Echo");
  dynamic::PipeEndpoint pipe = echo->pipe("counts").connect();
  pipe.send(std::uint32_t{41});
  for (const std::uint32_t expected : {41U, 42U}) {
    const auto packet = pipe.receive_for(20s);
    ASSERT_TRUE(packet.has_value());
    EXPECT_EQ(packet->as<std::uint32_t>(), expected);
  }
}

TEST_F(Bridged, ACallbackAsksTheClientThatCalled) {
  plug("echo115200.elf");
  const dynamic::Client idle = connect("Echo");
  const dynamic::Client asked = connect("Echo");
  idle->callback("doubled").set([](const List&) { return Value(-1.0); });
  asked->callback("doubled").set(
      [](const List& values) { return Value(2 * values.at(0).as<double>()); });
  asked->call("ask", {21.0});
  EXPECT_TRUE(eventually([&] { return idle->get("value").as<double>() == 42; }));
  asked->callback("doubled").clear();
  asked->call("ask", {21.0});
  EXPECT_TRUE(eventually([&] { return idle->get("value").as<double>() < 0; }))
      << "the code of the error, as the sketch keeps it";
}

TEST_F(Bridged, EverythingThatABoardServesArrives) {
  plug("everything.elf");
  const dynamic::Client all = connect("Board");
  all->set("big", std::int64_t{-1234567890123});
  EXPECT_EQ(all->get("big").as<std::int64_t>(), -1234567890123);
  all->set("text", "sixteen letters!");
  EXPECT_EQ(all->get("text").text(), "sixteen letters!");
  EXPECT_EQ(error_of([&] { all->set("text", "seventeen letters"); }).code(),
            ErrorCode::buffer_limit_violation);
  all->set("mode", "broken");
  EXPECT_EQ(all->get("mode").text(), "broken");
  all->set("numbers", List{1, -2, 3});
  EXPECT_EQ(all->get("numbers").size(), 3U);
  EXPECT_EQ(all->get("numbers").at(1).as<std::int32_t>(), -2);
  all->set("matrix", MultiArray<double>{{2, 2}, {1, 2, 3, 4}});
  EXPECT_EQ(all->get("matrix"), Value(MultiArray<double>{{2, 2}, {1, 2, 3, 4}}));
  const Value report =
      Value::record({{"name", "spindle"},
                     {"mode", "moving"},
                     {"where", Value::record({{"x", 1.5}, {"y", -2.5}})},
                     {"pairs", List{Value::record({{"first", 7}, {"rest", List{1, 2}}}),
                                    Value::record({{"first", -7}, {"rest", List{}}})}},
                     {"samples", List{0.5F, 1.5F}},
                     {"turn", std::complex<double>(0, 1)}});
  all->set("report", report);
  const Value back = all->get("report");
  EXPECT_EQ(back.at("name").text(), "spindle");
  EXPECT_EQ(back.at("where").at("y").as<double>(), -2.5);
  EXPECT_EQ(back.at("pairs").at(0).at("rest").size(), 2U);
  EXPECT_EQ(back.at("samples").size(), 2U);
  EXPECT_EQ(back.at("turn").as<std::complex<double>>(), std::complex<double>(0, 1));
  const dynamic::Object lamp = all->object("lamp", 2);
  lamp.set("level", 9);
  EXPECT_EQ(lamp.get("level").as<std::uint8_t>(), 9);
  EXPECT_EQ(all->object("lamp", 1).get("level").as<std::uint8_t>(), 0);
  EXPECT_EQ(all->object("motor").object("lamp").get("level").as<std::uint8_t>(), 0);
  EXPECT_EQ(error_of([&] { (void)all->object("lamp", 3); }).code(), ErrorCode::object_not_found);
  EXPECT_EQ(error_of([&] {
              all->call("add", {1.0, 2.0});
            }).code(),
            ErrorCode::not_implemented_error);
  dynamic::WireConnection wire = all->wire("both").connect();
  wire.set_out(std::int16_t{-5});
  EXPECT_TRUE(
      eventually([&] { return all->wire("both").peek_in().value.as<std::int16_t>() == -5; }));
}

TEST_F(Bridged, NumbersThatAnEnumDoesNotHavePass) {
  plug("everything.elf");
  const dynamic::Client all = connect("Board");
  all->set("mode", std::int32_t{12345});
  EXPECT_EQ(all->get("mode").to_json(), "12345");
  EXPECT_EQ(error_of([&] { all->set("mode", "walking"); }).code(), ErrorCode::data_type_mismatch);
}

TEST_F(Bridged, ARefusalSaysWhy) {
  plug("light.elf");
  const dynamic::Client light = connect("Light");
  const Error range = error_of([&] { light->set("color", color(2, 0, 0)); });
  EXPECT_EQ(range.code(), ErrorCode::out_of_range);
  EXPECT_EQ(range.message(),
            "color: the board refuses it: a value is out of range: the parts of a colour are from "
            "0 to 1");
  const Error length = error_of([&] { light->call("fade", {color(1, 0, 0), 61.0}); });
  EXPECT_EQ(length.message(),
            "fade: the board refuses it: a value is out of range: a fade takes 0 to 60 seconds");
  light->call("fade", {color(1, 0, 0), 0.1});

  board->unplug();
  board->plug(elf_dir + "stepper.elf");
  ASSERT_TRUE(eventually([&] { return times("Stepper: connected") == 1; }));
  const dynamic::Client stepper = connect("Stepper");
  const Error thrown = error_of([&] { stepper->call("move_to", {5}); });
  EXPECT_EQ(thrown.name(), "example.stepper.NotHomed");
  EXPECT_EQ(thrown.message(),
            "move_to: the board reports example.stepper.NotHomed: call home, and wait until it has "
            "ended");
}

TEST_F(Bridged, WhatTheLibraryRefusesSaysWhyToo) {
  plug("everything.elf");
  const dynamic::Client all = connect("Board");
  const Error longer = error_of([&] { all->set("text", "seventeen letters"); });
  EXPECT_EQ(longer.code(), ErrorCode::buffer_limit_violation);
  EXPECT_EQ(longer.message(),
            "text: the board refuses it: a string or array is longer than its limit in the "
            "definition");
  const Error missing = error_of([&] { all->call("add", {1.0, 2.0}); });
  EXPECT_EQ(missing.code(), ErrorCode::not_implemented_error);
  EXPECT_EQ(missing.message(), "add: the board refuses it: its program does not implement this");
  const Error lamp = error_of([&] { (void)all->object("lamp", 3); });
  EXPECT_EQ(lamp.code(), ErrorCode::object_not_found);
  EXPECT_EQ(lamp.message(), "lamp: the board refuses it: there is no such object");
}

TEST_F(Bridged, WhatIsTooLongForTheBoardIsRefusedAtOnce) {
  plug("everything.elf");
  const dynamic::Client all = connect("Board");
  const auto begun = std::chrono::steady_clock::now();
  const Error error = error_of([&] { all->set("text", std::string(100, 'x')); });
  EXPECT_EQ(error.code(), ErrorCode::buffer_limit_violation);
  EXPECT_EQ(error.message(),
            "text: the request has 103 bytes, and the board takes 80 at most: a string or array is "
            "longer than its limit in the definition");
  EXPECT_LT(std::chrono::steady_clock::now() - begun, 3s);
  all->set("text", "short");
  EXPECT_EQ(times("Board: connected"), 1U) << "the session goes on";
}

TEST_F(Bridged, RefusedPacketsAreLoggedOnce) {
  plug("everything.elf");
  const dynamic::Client all = connect("Board");
  dynamic::PipeEndpoint pipe = all->pipe("commands").connect();
  pipe.send(std::uint8_t{1});
  pipe.send(std::uint8_t{2});
  const std::string line =
      "Board: a packet was lost: commands: the board refuses it: its program does not implement "
      "this";
  EXPECT_TRUE(eventually([&] { return times(line) == 1; }));
  all->set("secret", std::uint8_t{1});
  EXPECT_EQ(times(line), 1U);
}

TEST_F(Bridged, RefusedValuesOfWiresAreLogged) {
  plug("conformance.elf");
  const dynamic::Client panel = connect("Panel");
  dynamic::WireConnection wire = panel->wire("target").connect();
  wire.set_out(1e7);
  EXPECT_TRUE(eventually([&] {
    return times(
               "Panel: a value of a wire was lost: target: the board refuses it: a value is out "
               "of range: at most a million") == 1;
  }));
  wire.set_out(5.0);
  EXPECT_TRUE(eventually([&] { return panel->call("last_target", {}).as<double>() == 5; }));
}

TEST_F(Bridged, ACallbackComesToTheClientThatCalledLongAgo) {
  plug("echo115200.elf");
  const dynamic::Client echo = connect("Echo");
  echo->callback("doubled").set(
      [](const List& values) { return Value(2 * values.at(0).as<double>()); });
  // Asked two seconds later: meanwhile the bridge has looked whether the board is there.
  echo->call("ask", {-21.0});
  std::this_thread::sleep_for(3s);
  EXPECT_TRUE(eventually([&] { return echo->get("value").as<double>() != 0; }));
  EXPECT_EQ(echo->get("value").as<double>(), -42);
}

TEST(BoardPlaces, AreReadFromUrls) {
  const BoardPlace place = BoardPlace::parse("rr+serial:///dev/ttyUSB0?baud=9600&name=lamp");
  EXPECT_EQ(place.path, "/dev/ttyUSB0");
  EXPECT_EQ(place.baud, 9600U);
  EXPECT_EQ(place.name, "lamp");
  EXPECT_EQ(BoardPlace::parse("/dev/ttyACM0").baud, 115200U);
  EXPECT_EQ(BoardPlace::parse("tcp://lamp.local:4000?name=lamp").path, "tcp://lamp.local:4000");
  EXPECT_EQ(BoardPlace::parse("rr+serial://[::1]:4000/?service=Echo").path, "tcp://[::1]:4000");
  for (const char* const bad :
       {"", "?baud=9600", "/dev/x?baud=9601", "/dev/x?baud=fast", "/dev/x?b=1", "tcp://",
        "tcp://lamp", "tcp://lamp:0", "tcp://lamp:65536", "tcp://lamp:40x", "tcp://:4000",
        "tcp://::1:4000", "tcp://lamp:4000?baud=9600", "rr+serial://lamp"}) {
    EXPECT_EQ(error_of([&] { (void)BoardPlace::parse(bad); }).code(), ErrorCode::invalid_argument)
        << bad;
  }
}

}  // namespace
}  // namespace rr::serial::testing
