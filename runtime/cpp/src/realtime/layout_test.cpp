// SPDX-License-Identifier: Apache-2.0
#include "rr/realtime/layout.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "rr/error.hpp"
#include "rr/realtime/state_bus.hpp"
#include "runtime/cpp/src/realtime/testing/arm_pod.hpp"

namespace rr::realtime {
namespace {

using testing::arm_layout;
using testing::ArmPod;

ErrorCode code_of(const std::function<void()>& what) {
  try {
    what();
  } catch (const Error& error) {
    return error.code();
  }
  return ErrorCode::none;
}

TEST(RealtimeLayout, PacksWithoutGapsLeastSignificantByteFirst) {
  const Layout layout = arm_layout();
  EXPECT_EQ(layout.packed_size(), 1U + 48 + 1 + 2 + 8);
  const ArmPod pod{.mode = 3, .q = {1}, .has_fault = true, .temperature = -2, .sample = 0x0102};
  std::vector<std::byte> bytes(layout.packed_size());
  layout.pack(&pod, bytes);
  EXPECT_EQ(bytes[0], std::byte{3});
  EXPECT_EQ(bytes[7], std::byte{0xF0}) << "1.0 is 3FF0 and six zeros";
  EXPECT_EQ(bytes[8], std::byte{0x3F});
  EXPECT_EQ(bytes[49], std::byte{1});
  EXPECT_EQ(bytes[50], std::byte{0xFE});
  EXPECT_EQ(bytes[51], std::byte{0xFF});
  EXPECT_EQ(bytes[52], std::byte{2});
  EXPECT_EQ(bytes[53], std::byte{1});
  ArmPod back;
  layout.unpack(bytes, &back);
  EXPECT_EQ(back, pod);
}

TEST(RealtimeLayout, ABoolIsTrueForEverythingButZero) {
  const Layout layout = arm_layout();
  std::vector<std::byte> bytes(layout.packed_size());
  bytes[49] = std::byte{7};
  ArmPod pod;
  layout.unpack(bytes, &pod);
  EXPECT_TRUE(pod.has_fault);
  layout.pack(&pod, bytes);
  EXPECT_EQ(bytes[49], std::byte{1});
}

TEST(RealtimeLayout, TheHashTellsNamesTypesCountsAndOrderApart) {
  const auto hash = [](const char* name, SignalType type, std::uint32_t count) {
    const std::vector<SignalEntry> entries{{name, type, count, 0}};
    return Layout("a.B", entries, 64).hash();
  };
  const auto first = hash("q", SignalType::double_, 2);
  EXPECT_EQ(first, hash("q", SignalType::double_, 2));
  EXPECT_NE(first, hash("p", SignalType::double_, 2));
  EXPECT_NE(first, hash("q", SignalType::int64, 2));
  EXPECT_NE(first, hash("q", SignalType::double_, 1));
}

TEST(RealtimeLayout, RefusesTablesThatAreWrong) {
  const auto refused = [](std::vector<SignalEntry> entries, std::size_t size) {
    return code_of([&] { Layout("a.B", entries, size); }) == ErrorCode::invalid_argument;
  };
  EXPECT_TRUE(refused({}, 8));
  EXPECT_TRUE(refused({{"q", SignalType::double_, 1, 1}}, 8));
  EXPECT_TRUE(refused({{"q", SignalType::double_, 0x40000000, 0}}, 8));
  EXPECT_TRUE(refused({{"q", SignalType{11}, 1, 0}}, 8));
  EXPECT_TRUE(refused({{"q", SignalType::int8, 1, 0}, {"q", SignalType::int8, 1, 1}}, 8));
  EXPECT_TRUE(refused({{"q", SignalType::uint8, 2000, 0}}, 2000));
}

TEST(RealtimeBus, ReadsAndSetsSignalsByName) {
  SignalGroup<ArmPod> state;
  CommandGroup<ArmPod> command;
  StateBus bus;
  bus.add("state", arm_layout(), state);
  bus.add("command", arm_layout(), command);
  EXPECT_EQ(bus.signal_names().size(), 10U);

  state.write({.q = {1, 2, 3, 4, 5, 6}, .temperature = -7});
  EXPECT_EQ(bus.get("state.q"), (std::vector<double>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(bus.get("state.temperature"), std::vector<double>{-7});
  EXPECT_EQ(bus.snapshot("state").size(), arm_layout().packed_size());

  bus.set("command.mode", 2);
  bus.set("command.q", std::vector<double>{0.5, 0.25});
  EXPECT_TRUE(command.take());
  EXPECT_EQ(command.value(), (ArmPod{.mode = 2, .q = {0.5, 0.25}}));
  EXPECT_FALSE(command.take());
}

// Called under a lock it could not use the group; what is set meanwhile would be lost without the
// second call.
TEST(CommandGroups, AChangeSeesWhatWasSetWhileItWasMade) {
  CommandGroup<ArmPod> command;
  int calls = 0;
  command.update([&](ArmPod& value) {
    if (++calls == 1) command.set({.temperature = 3});
    value.mode = 2;
  });
  EXPECT_EQ(calls, 2);
  EXPECT_EQ(command.newest().temperature, 3);
  EXPECT_EQ(command.newest().mode, 2);
  ASSERT_TRUE(command.take());
  EXPECT_EQ(command.value().temperature, 3);
  EXPECT_EQ(command.value().mode, 2);
}

TEST(RealtimeBus, RefusesWhatItCannotHold) {
  SignalGroup<ArmPod> state;
  CommandGroup<ArmPod> command;
  StateBus bus;
  bus.add("state", arm_layout(), state);
  bus.add("command", arm_layout(), command);
  EXPECT_EQ(code_of([&] { bus.set("state.q", 1); }), ErrorCode::read_only_member);
  EXPECT_EQ(code_of([&] { bus.set("command.speed", 1); }), ErrorCode::key_not_found);
  EXPECT_EQ(code_of([&] { (void)bus.get("q"); }), ErrorCode::key_not_found);
  EXPECT_EQ(code_of([&] { bus.set("command.mode", 256); }), ErrorCode::out_of_range);
  EXPECT_EQ(code_of([&] { bus.set("command.mode", 0.5); }), ErrorCode::out_of_range);
  EXPECT_EQ(code_of([&] { bus.set("command.has_fault", 2); }), ErrorCode::out_of_range);
  EXPECT_EQ(code_of([&] { bus.set("command.q", 1, 6); }), ErrorCode::out_of_range);
  EXPECT_EQ(code_of([&] { bus.set("command.temperature", 32768); }), ErrorCode::out_of_range);
  EXPECT_EQ(code_of([&] { bus.set("command.q", std::vector<double>(7)); }),
            ErrorCode::out_of_range);
  EXPECT_EQ(code_of([&] { bus.add("state", arm_layout(), state); }), ErrorCode::invalid_argument);
  EXPECT_FALSE(command.take()) << "nothing was set";
  bus.set("command.temperature", -32768);
  EXPECT_TRUE(command.take());
}

}  // namespace
}  // namespace rr::realtime
