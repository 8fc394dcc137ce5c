// SPDX-License-Identifier: Apache-2.0
// Clients that reach a board by `rr+serial`, without a bridge.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/file.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <fstream>
#include <optional>
#include <string>

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
using ::testing::HasSubstr;

NodeOptions with_serial() { return {.channels = {{"rr+serial", serial_channel()}}}; }

Error error_of_connecting(const std::string& url) {
  NodeOptions options = with_serial();
  options.connect_timeout = 2s;
  Node node(options);
  return error_of([&] { (void)dynamic::connect(node, url); });
}

/// The port as another program has it; nothing when somebody has it already.
class Taken {
 public:
  explicit Taken(const std::string& path)
      : port_(::open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC)),
        is_taken_(port_ >= 0 && ::flock(port_, LOCK_EX | LOCK_NB) == 0) {}
  ~Taken() { ::close(port_); }
  Taken(const Taken&) = delete;
  Taken& operator=(const Taken&) = delete;
  explicit operator bool() const { return is_taken_; }

 private:
  const int port_;
  const bool is_taken_;
};

TEST(SerialUrls, LeadToTheServiceOfABoard) {
  PluggedBoard board(elf_dir + "echo115200.elf");
  Node node(with_serial());
  const std::string url = "rr+serial://" + board.path();
  for (const std::string& same :
       {url, url + "?baud=115200", url + "?service=Echo", url + "?baud=115200&service=Echo"}) {
    const dynamic::Client echo = dynamic::connect(node, same);
    EXPECT_EQ(echo->path(), "Echo");
    EXPECT_EQ(echo->call("add", {20.0, 22.0}).as<double>(), 42);
  }
  EXPECT_EQ(error_of_connecting(url + "?service=Echos").code(), ErrorCode::service_not_found);
}

TEST(SerialUrls, AreSharedInAProcess) {
  PluggedBoard board(elf_dir + "echo115200.elf");
  const std::string url = "rr+serial://" + board.path();
  std::atomic<int> added = 0;
  {
    Node one(with_serial());
    Node another(with_serial());
    const dynamic::Client first = dynamic::connect(one, url);
    {
      const dynamic::Client second = dynamic::connect(another, url);
      const Subscription subscription = second->on_event("added", [&](const List&) { ++added; });
      first->call("add", {1.0, 2.0});
      EXPECT_TRUE(eventually([&] { return added == 1; }));
      EXPECT_EQ(second->get("count").as<std::uint32_t>(), 1U);
      EXPECT_EQ(error_of([&] { (void)dynamic::connect(one, url + "?baud=9600"); }).code(),
                ErrorCode::invalid_argument);
    }
    EXPECT_EQ(first->get("count").as<std::uint32_t>(), 1U) << "the line outlives the second";
    EXPECT_FALSE(Taken(board.path())) << "another program cannot disturb";
  }
  EXPECT_TRUE(eventually([&] { return static_cast<bool>(Taken(board.path())); }))
      << "the port is free again";
}

TEST(SerialUrls, SayWhyTheyLeadNowhere) {
  PluggedBoard board(elf_dir + "echo115200.elf");
  {
    const Taken taken(board.path());
    ASSERT_TRUE(static_cast<bool>(taken));
    const Error error = error_of_connecting("rr+serial://" + board.path());
    EXPECT_EQ(error.code(), ErrorCode::connection_error);
    EXPECT_THAT(error.message(), HasSubstr(board.path() + " is in use, by another program"));
  }
  board.set_silent(true);
  const Error silent = error_of_connecting("rr+serial://" + board.path());
  EXPECT_EQ(silent.code(), ErrorCode::connection_error);
  EXPECT_THAT(silent.message(), HasSubstr("the board at " + board.path() + " does not answer"));
  const Error missing = error_of_connecting("rr+serial:///dev/there_is_no_such_port");
  EXPECT_EQ(missing.code(), ErrorCode::connection_error);
  EXPECT_THAT(missing.message(), HasSubstr("/dev/there_is_no_such_port does not exist"));
  EXPECT_THAT(error_of_connecting("rr+serial:///dev/null").message(),
              HasSubstr("is no serial port"));
  for (const char* const bad :
       {"rr+serial://", "rr+serial://dev/ttyUSB0", "rr+serial:///dev/null?baud=1"}) {
    EXPECT_EQ(error_of_connecting(bad).code(), ErrorCode::invalid_argument) << bad;
  }
}

TEST(SerialUrls, NeedTheirChannel) {
  Node node;
  const Error error = error_of([&] { (void)dynamic::connect(node, "rr+serial:///dev/null"); });
  EXPECT_EQ(error.code(), ErrorCode::invalid_argument);
  EXPECT_THAT(error.message(), HasSubstr("rr::serial_channel()"));
  Node other(with_serial());
  EXPECT_EQ(error_of([&] { other.listen("rr+serial:///dev/null"); }).code(),
            ErrorCode::invalid_operation);
}

TEST(SerialUrls, CanBeSubscribedTo) {
  std::optional<PluggedBoard> board(elf_dir + "light.elf");
  Node node(with_serial());
  ServiceSubscription lights = dynamic::subscribe(node, "rr+serial://" + board->path());
  const WireSubscription<Value> sensor = lights.subscribe_wire<Value>("sensor");
  EXPECT_TRUE(sensor.wait_in(20s));
  EXPECT_EQ(lights.connected_clients().size(), 1U);
  lights.close();
  // The filter sees the name that the URL leaves out.
  SubscriptionOptions others;
  others.filter.service_names = {"Lamp"};
  ServiceSubscription none =
      dynamic::subscribe(node, "rr+serial://" + board->path(), std::move(others));
  EXPECT_TRUE(eventually([&] { return none.last_error().has_value(); }));
  EXPECT_TRUE(none.connected_clients().empty());
}

/// What a program prints.
std::string output_of(const std::string& command) {
  FILE* const pipe = ::popen(command.c_str(), "r");
  std::string output;
  for (int byte = std::fgetc(pipe); byte != EOF; byte = std::fgetc(pipe)) {
    output.push_back(static_cast<char>(byte));
  }
  ::pclose(pipe);
  return output;
}

TEST(SerialUrls, WorkOnTheCommandLine) {
  PluggedBoard board(elf_dir + "echo115200.elf");
  const std::string url = "'rr+serial://" + board.path() + "?baud=115200'";
  const std::string robdef = ROBDEF_PROGRAM;
  EXPECT_EQ(output_of(robdef + " call " + url + " add 1 2"), "3\n");
  EXPECT_EQ(output_of(robdef + " get " + url + " count"), "1\n");
  Node node(with_serial());
  const dynamic::Client here = dynamic::connect(node, "rr+serial://" + board.path());
  EXPECT_THAT(output_of(robdef + " get " + url + " count 2>&1"),
              HasSubstr("is in use, by another program"));
}

}  // namespace
}  // namespace rr::serial::testing
