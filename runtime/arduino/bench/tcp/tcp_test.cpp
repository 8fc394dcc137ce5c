// SPDX-License-Identifier: Apache-2.0
// Boards that serve over TCP: the library for sketches in a program of its own, for clients behind
// a bridge and for those at rr+serial.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstdio>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "rr/dynamic.hpp"
#include "rr/node.hpp"
#include "rr/serial.hpp"
#include "runtime/arduino/bench/tcp/between.hpp"
#include "runtime/arduino/bench/tcp/board_process.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::serial::testing {
namespace {

using namespace std::chrono_literals;
using dynamic::List;
using dynamic::Value;
using rr::testing::error_of;
using rr::testing::eventually;
using ::testing::HasSubstr;

enum class Way { bridge, serial };

class OverTcp : public ::testing::TestWithParam<Way> {
 protected:
  /// The service of the board that is reached at this port.
  dynamic::Client connect(std::uint16_t port) {
    const std::string place = "127.0.0.1:" + std::to_string(port);
    if (GetParam() == Way::serial) return dynamic::connect(node, "rr+serial://" + place);
    bridge = std::make_unique<BoardBridge>(server);
    bridge->add(BoardPlace::parse("tcp://" + place));
    EXPECT_TRUE(bridge->wait(20s));
    return dynamic::connect(
        node, "rr+tcp://127.0.0.1:" + std::to_string(server.listen_tcp(0, "127.0.0.1")) +
                  "/?service=Echo");
  }
  static bool comes_back(const dynamic::Client& echo) {
    return eventually(
        [&] { return error_of([&] { (void)echo->get("count"); }).code() == ErrorCode::none; });
  }

  BoardProcess board{RR_TCP_BOARD};
  Node server;
  Node node{{.channels = {{"rr+serial", serial_channel()}}}};
  std::unique_ptr<BoardBridge> bridge;
};

TEST_P(OverTcp, ABoardIsAServiceLikeAnyOther) {
  const dynamic::Client echo = connect(board.port());
  EXPECT_EQ(echo->type_name(), "example.echo.Echo");
  std::atomic<std::uint32_t> added = 0;
  const Subscription events = echo->on_event(
      "added", [&](const List& arguments) { added = arguments.at(0).as<std::uint32_t>(); });
  EXPECT_EQ(echo->call("add", {20.0, 22.0}).as<double>(), 42);
  EXPECT_TRUE(eventually([&] { return added == 1; }));
  dynamic::PipeEndpoint pipe = echo->pipe("counts").connect();
  pipe.send(std::uint32_t{41});
  for (const std::uint32_t expected : {41U, 42U}) {
    const auto packet = pipe.receive_for(20s);
    ASSERT_TRUE(packet.has_value());
    EXPECT_EQ(packet->as<std::uint32_t>(), expected);
  }
  echo->callback("doubled").set(
      [](const List& values) { return Value(2 * values.at(0).as<double>()); });
  echo->call("ask", {21.0});
  EXPECT_TRUE(eventually([&] { return echo->get("value").as<double>() == 42; }));
}

TEST_P(OverTcp, DamagedBytesAreNeverTaken) {
  Between between(board.port(), {.damage = 0.005, .drop = 0.002, .twice = 0.002, .burst = 0.002},
                  1);
  const dynamic::Client echo = connect(between.port());
  for (int count = 1; count <= 40; ++count) {
    ASSERT_EQ(echo->call("add", {count * 1.5, 1.0}).as<double>(), count * 1.5 + 1);
  }
  EXPECT_EQ(echo->get("count").as<std::uint32_t>(), 40U) << "each is carried out once";
}

TEST_P(OverTcp, AConnectionThatIsCutComesBack) {
  Between between(board.port(), {}, 1);
  const dynamic::Client echo = connect(between.port());
  for (int round = 0; round < 5; ++round) {
    ASSERT_TRUE(comes_back(echo));
    std::thread cutter([&] {
      std::this_thread::sleep_for(100ms);
      between.cut();
    });
    const auto begun = std::chrono::steady_clock::now();
    const Error error = error_of([&] { echo->call("wait", {std::uint16_t{400}}); });
    cutter.join();
    EXPECT_EQ(error.code(), ErrorCode::connection_error);
    EXPECT_LT(std::chrono::steady_clock::now() - begun, 350ms) << "the client learns it at once";
  }
  ASSERT_TRUE(comes_back(echo));
  EXPECT_GE(between.connections(), 6);
}

TEST_P(OverTcp, AConnectionThatDiesInSilenceIsReplaced) {
  Between between(board.port(), {}, 1);
  const dynamic::Client echo = connect(between.port());
  EXPECT_EQ(echo->call("add", {1.0, 2.0}).as<double>(), 3);
  between.swallow();
  // Neither end is told that the other one is gone.
  ASSERT_TRUE(eventually([&] {
    return error_of([&] { (void)echo->get("count"); }).code() == ErrorCode::connection_error;
  }));
  ASSERT_TRUE(comes_back(echo));
  EXPECT_EQ(echo->get("count").as<std::uint32_t>(), 1U) << "the board has been on all the time";
}

TEST_P(OverTcp, ABoardThatLosesItsPowerInACallFailsIt) {
  const dynamic::Client echo = connect(board.port());
  EXPECT_EQ(echo->call("add", {1.0, 2.0}).as<double>(), 3);
  std::thread killer([&] {
    std::this_thread::sleep_for(200ms);
    board.kill();
  });
  const Error error = error_of([&] { echo->call("wait", {std::uint16_t{5000}}); });
  killer.join();
  EXPECT_EQ(error.code(), ErrorCode::connection_error);
  EXPECT_EQ(error_of([&] { (void)echo->get("count"); }).code(), ErrorCode::connection_error);
  board.start();
  ASSERT_TRUE(comes_back(echo));
  EXPECT_EQ(echo->get("count").as<std::uint32_t>(), 0U) << "the same client, the board anew";
}

TEST_P(OverTcp, ABoardThatHangsInACallFailsItAndComesBack) {
  const dynamic::Client echo = connect(board.port());
  EXPECT_EQ(echo->call("add", {1.0, 2.0}).as<double>(), 3);
  board.freeze();
  const Error error = error_of([&] { (void)echo->get("count"); });
  EXPECT_EQ(error.code(), ErrorCode::request_timeout);
  EXPECT_EQ(error_of([&] { (void)echo->get("count"); }).code(), ErrorCode::connection_error);
  board.thaw();
  ASSERT_TRUE(comes_back(echo));
  EXPECT_EQ(echo->get("count").as<std::uint32_t>(), 1U);
}

INSTANTIATE_TEST_SUITE_P(Ways, OverTcp, ::testing::Values(Way::bridge, Way::serial),
                         [](const auto& info) {
                           return info.param == Way::bridge ? "Bridge" : "Serial";
                         });

class TcpBoards : public ::testing::Test {
 protected:
  Error error_of_connecting(std::uint16_t port) {
    NodeOptions options{.channels = {{"rr+serial", serial_channel()}}};
    options.connect_timeout = 2s;
    Node node(options);
    return error_of(
        [&] { (void)dynamic::connect(node, "rr+serial://127.0.0.1:" + std::to_string(port)); });
  }
};

TEST_F(TcpBoards, ThatAreNotThereAreToldAtOnce) {
  BoardProcess board(RR_TCP_BOARD);
  board.kill();
  const auto begun = std::chrono::steady_clock::now();
  const Error error = error_of_connecting(board.port());
  EXPECT_EQ(error.code(), ErrorCode::connection_error);
  EXPECT_THAT(error.message(), HasSubstr("refuses connections"));
  EXPECT_LT(std::chrono::steady_clock::now() - begun, 1500ms);
}

TEST_F(TcpBoards, ServeOneHostAtATime) {
  BoardProcess board(RR_TCP_BOARD);
  std::mutex mutex;
  std::vector<std::string> said;
  Node server;
  auto first = std::make_unique<BoardBridge>(server);
  first->add(BoardPlace::parse("tcp://127.0.0.1:" + std::to_string(board.port())));
  ASSERT_TRUE(first->wait(20s));
  Node other;
  BoardBridge second(other, [&](const std::string& text) {
    const std::lock_guard lock(mutex);
    said.push_back(text);
  });
  second.add(BoardPlace::parse("tcp://127.0.0.1:" + std::to_string(board.port())));
  EXPECT_FALSE(second.wait(1s));
  {
    const std::lock_guard lock(mutex);
    ASSERT_FALSE(said.empty());
    EXPECT_THAT(said.front(), HasSubstr("it serves one host at a time"));
  }
  Node node;
  const dynamic::Client echo = dynamic::connect(
      node,
      "rr+tcp://127.0.0.1:" + std::to_string(server.listen_tcp(0, "127.0.0.1")) + "/?service=Echo");
  EXPECT_EQ(echo->call("add", {1.0, 2.0}).as<double>(), 3) << "the first goes on";
  first.reset();
  EXPECT_TRUE(second.wait(20s));
}

TEST_F(TcpBoards, AreUsedFromTheCommandLine) {
  BoardProcess board(RR_TCP_BOARD);
  const std::string command = std::string(ROBDEF_PROGRAM) +
                              " call rr+serial://127.0.0.1:" + std::to_string(board.port()) +
                              " add 20 22";
  FILE* const program = ::popen(command.c_str(), "r");
  ASSERT_NE(program, nullptr);
  char text[64] = {};
  (void)!::fread(text, 1, sizeof text - 1, program);
  EXPECT_EQ(::pclose(program), 0);
  EXPECT_STREQ(text, "42\n");
}

}  // namespace
}  // namespace rr::serial::testing
