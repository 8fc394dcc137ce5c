// SPDX-License-Identifier: Apache-2.0
// Cables that are pulled and plugged in again, for clients behind a bridge and for those at
// rr+serial.
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "rr/dynamic.hpp"
#include "rr/node.hpp"
#include "rr/serial.hpp"
#include "rr/subscription.hpp"
#include "runtime/arduino/bench/elf_dir.hpp"
#include "runtime/arduino/bench/plugged_board.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::serial::testing {
namespace {

using namespace std::chrono_literals;
using dynamic::List;
using dynamic::Value;
using rr::testing::error_of;
using rr::testing::eventually;

enum class Way { bridge, serial };

class Unplugged : public ::testing::TestWithParam<Way> {
 protected:
  /// A board, and the URL of its service.
  std::string plug(const std::string& elf, const std::string& service) {
    board = std::make_unique<PluggedBoard>(elf_dir + elf);
    if (GetParam() == Way::serial) return "rr+serial://" + board->path() + "?service=" + service;
    bridge = std::make_unique<BoardBridge>(server);
    bridge->add({.path = board->path()});
    EXPECT_TRUE(bridge->wait(20s));
    const auto port = server.listen_tcp(0, "127.0.0.1");
    return "rr+tcp://127.0.0.1:" + std::to_string(port) + "/?service=" + service;
  }
  /// Whether the client's calls work, at last.
  static bool comes_back(const dynamic::Client& client, const char* property) {
    return eventually(
        [&] { return error_of([&] { (void)client->get(property); }).code() == ErrorCode::none; });
  }

  Node server;
  Node node{{.channels = {{"rr+serial", serial_channel()}}}};
  std::unique_ptr<PluggedBoard> board;
  std::unique_ptr<BoardBridge> bridge;
};

TEST_P(Unplugged, CallsFailUntilTheBoardIsBack) {
  const std::string url = plug("echo115200.elf", "Echo");
  const dynamic::Client echo = dynamic::connect(node, url);
  EXPECT_EQ(echo->call("add", {1.0, 2.0}).as<double>(), 3);
  for (int round = 0; round < 2; ++round) {
    board->unplug();
    EXPECT_EQ(error_of([&] { (void)echo->get("count"); }).code(), ErrorCode::connection_error);
    EXPECT_EQ(error_of([&] { echo->call("add", {1.0, 2.0}); }).code(), ErrorCode::connection_error);
    board->plug();
    EXPECT_TRUE(comes_back(echo, "count"));
    EXPECT_EQ(echo->get("count").as<std::uint32_t>(), 0U) << "its program has begun anew";
    EXPECT_EQ(echo->call("add", {1.0, 2.0}).as<double>(), 3);
  }
}

TEST_P(Unplugged, ACallUnderWayFailsAtOnce) {
  const std::string url = plug("echo115200.elf", "Echo");
  const dynamic::Client echo = dynamic::connect(node, url);
  std::thread puller([&] {
    std::this_thread::sleep_for(200ms);
    board->unplug();
  });
  const auto begun = std::chrono::steady_clock::now();
  const Error error = error_of([&] { echo->call("wait", {std::uint16_t{20000}}); });
  puller.join();
  EXPECT_EQ(error.code(), ErrorCode::connection_error);
  EXPECT_LT(std::chrono::steady_clock::now() - begun, 4s) << "long before its time is over";
  board->plug();
  EXPECT_TRUE(comes_back(echo, "count"));
}

TEST_P(Unplugged, AResetInACallFailsItAndNothingElse) {
  const std::string url = plug("echo115200.elf", "Echo");
  const dynamic::Client echo = dynamic::connect(node, url);
  const dynamic::Client another = dynamic::connect(node, url);
  dynamic::PipeEndpoint pipe = another->pipe("counts").connect();
  std::thread resetter([&] {
    std::this_thread::sleep_for(200ms);
    board->reset();
  });
  const Error error = error_of([&] { echo->call("wait", {std::uint16_t{3000}}); });
  resetter.join();
  EXPECT_EQ(error.code(), ErrorCode::connection_error);
  EXPECT_TRUE(comes_back(echo, "count"));
  EXPECT_TRUE(another.is_open());
  EXPECT_TRUE(eventually([&] {
    pipe.send(std::uint32_t{1});
    return pipe.receive_for(100ms).has_value();
  })) << "what the other client had open is opened again";
}

TEST_P(Unplugged, EventsAndWiresGoOn) {
  const std::string url = plug("light.elf", "Light");
  const dynamic::Client light = dynamic::connect(node, url);
  std::atomic<int> faded = 0;
  std::atomic<int> values = 0;
  const Subscription event = light->on_event("faded", [&](const List&) { ++faded; });
  dynamic::WireConnection wire = light->wire("sensor").connect();
  const Subscription sensed = wire.on_in([&](const Value&, const TimeSpec&) { ++values; });
  EXPECT_TRUE(eventually([&] { return values >= 2; }));
  board->unplug();
  EXPECT_EQ(error_of([&] { (void)light->get("brightness"); }).code(), ErrorCode::connection_error);
  EXPECT_TRUE(wire.is_open()) << "the client has nothing to do";
  const int before = values;
  board->plug();
  EXPECT_TRUE(comes_back(light, "brightness"));
  EXPECT_TRUE(eventually([&] { return values >= before + 2; }));
  const Value target = Value::record({{"red", 0.5F}, {"green", 0.5F}, {"blue", 0.5F}});
  light->call("fade", {target, 0.05});
  EXPECT_TRUE(eventually([&] { return faded == 1; }));
}

TEST_P(Unplugged, PipesGoOn) {
  const std::string url = plug("echo115200.elf", "Echo");
  const dynamic::Client echo = dynamic::connect(node, url);
  dynamic::PipeEndpoint pipe = echo->pipe("counts").connect();
  board->unplug();
  EXPECT_EQ(error_of([&] { (void)echo->get("count"); }).code(), ErrorCode::connection_error);
  board->plug();
  EXPECT_TRUE(comes_back(echo, "count"));
  // Nothing says when the board has opened its end again; what it gets before is lost.
  const bool came = eventually([&] {
    pipe.send(std::uint32_t{41});
    return pipe.receive_for(100ms).has_value();
  });
  EXPECT_TRUE(came);
  EXPECT_TRUE(pipe.is_open());
}

TEST_P(Unplugged, AnotherProgramIsAnotherService) {
  const std::string url = plug("light.elf", "Light");
  std::atomic<int> closed = 0;
  ConnectOptions options;
  options.on_closed = [&](const Error&) { ++closed; };
  const dynamic::Client light = dynamic::connect(node, url, std::move(options));
  ServiceSubscription lights = dynamic::subscribe(node, url);
  const WireSubscription<Value> sensor = lights.subscribe_wire<Value>("sensor");
  EXPECT_TRUE(sensor.wait_in(20s));
  board->unplug();
  board->plug(elf_dir + "stepper.elf");
  EXPECT_TRUE(eventually([&] { return closed == 1; })) << "the client is told";
  EXPECT_TRUE(eventually([&] { return lights.connected_clients().empty(); }));
  EXPECT_FALSE(light.is_open());
  board->unplug();
  board->plug(elf_dir + "light.elf");
  EXPECT_TRUE(eventually([&] { return lights.connected_clients().size() == 1; }))
      << "and a subscription connects by itself";
  EXPECT_TRUE(sensor.wait_in(20s));
}

INSTANTIATE_TEST_SUITE_P(Ways, Unplugged, ::testing::Values(Way::bridge, Way::serial),
                         [](const auto& one) {
                           return one.param == Way::bridge ? "Bridge" : "Serial";
                         });

}  // namespace
}  // namespace rr::serial::testing
