// SPDX-License-Identifier: Apache-2.0
// Serial ports as the header promises them on every system; what travels is in tests with boards.
#include "runtime/cpp/src/platform/serial_port.hpp"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <string>
#include <thread>

#include "rr/serial.hpp"
#include "runtime/cpp/src/platform/sockets.hpp"

namespace rr::platform {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

bool is_windows() { return std::string(serial_port_example()) == "COM3"; }

TEST(SerialPorts, HaveNames) {
  EXPECT_EQ(serial_port_name(""), std::nullopt);
  if (!is_windows()) {
    EXPECT_EQ(serial_port_name("/dev/ttyUSB0"), "/dev/ttyUSB0");
    return;
  }
  for (const char* const same : {"COM3", "com3", "/COM3", "/com3", R"(\\.\COM3)", "//./com3"}) {
    EXPECT_EQ(serial_port_name(same), "COM3") << same;
  }
  EXPECT_EQ(serial_port_name("/cnca0"), "CNCA0");
  for (const char* const none : {"/", "//./", "/dev/ttyUSB0", "C:", "//server/COM3", "COM 3", "3",
                                 R"(\\.\pipe\COM3)", "COM3\n"}) {
    EXPECT_EQ(serial_port_name(none), std::nullopt) << none;
  }
}

TEST(SerialPorts, AreNamedAlikeInPlacesOfBoards) {
  const std::string name = serial_port_example();
  EXPECT_EQ(BoardPlace::parse(name).path, name);
  const std::string url = is_windows() ? "rr+serial:///com3" : "rr+serial://" + name;
  const BoardPlace place = BoardPlace::parse(url + "?baud=9600&name=lamp");
  EXPECT_EQ(place.path, name);
  EXPECT_EQ(place.baud, 9600U);
  EXPECT_EQ(place.name, "lamp");
  EXPECT_EQ(BoardPlace::parse("tcp://[::1]:4000").path, "tcp://[::1]:4000");
}

TEST(SerialPorts, SayWhyTheyCannotBeOpened) {
  SerialPort port;
  EXPECT_EQ(port.open(is_windows() ? "COM99" : "/dev/there_is_none", 9600), "does not exist");
  EXPECT_EQ(port.open(is_windows() ? "NUL" : "/dev/null", 9600), "is no serial port");
  EXPECT_FALSE(port.is_open());
}

// Also while it is not open: the next attempt to open one need not be waited for.
TEST(SerialPorts, AreWoken) {
  SerialPort port;
  std::array<std::byte, 8> room;
  const auto begin = Clock::now();
  std::thread other([&] {
    std::this_thread::sleep_for(50ms);
    port.wake();
  });
  EXPECT_EQ(port.receive(room, begin + 1h), nothing_now);
  other.join();
  port.wake();
  EXPECT_EQ(port.receive(room, begin + 1h), nothing_now);
  EXPECT_EQ(port.receive(room, begin), nothing_now) << "at the deadline";
}

}  // namespace
}  // namespace rr::platform
