// SPDX-License-Identifier: Apache-2.0
// The C of `robdef generate --lang cbus` and the C++ codec of UDP frames: two programs that know
// nothing of each other make the same bytes.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "experimental/arm.hpp"
#include "experimental/motion.hpp"
#include "experimental_arm_bus.h"
#include "experimental_motion_bus.h"
#include "rr/realtime/service.hpp"
#include "rr/realtime/state_channel.hpp"
#include "rr_bus.h"

namespace rr::realtime {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::span<std::byte> as_bytes(Bytes& bytes) { return std::as_writable_bytes(std::span(bytes)); }

/// Any bytes, but for bools, which are 0 or 1.
Bytes random_bytes(const Layout& layout, std::mt19937_64& random) {
  Bytes bytes(layout.packed_size());
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
  for (const Signal& signal : layout.signals()) {
    if (signal.type != SignalType::bool_) continue;
    for (std::uint32_t i = 0; i < signal.count; ++i) bytes[signal.place + i] &= 1;
  }
  return bytes;
}

template <class Pod, class CPod>
void expect_same_bytes(void (*c_pack)(const CPod*, std::uint8_t*),
                       void (*c_unpack)(const std::uint8_t*, CPod*),
                       void (*c_frame)(const CPod*, rr_bus_frame*, std::uint8_t*),
                       std::uint64_t c_hash, int count) {
  const Layout layout = layout_of<Pod>();
  EXPECT_EQ(layout.hash(), c_hash);
  std::mt19937_64 random(2011);
  StateOutput output(layout, 7);
  rr_bus_frame header{.schema = 0, .epoch = 7, .sequence = 0, .stamp = 0};
  int different = 0;
  for (int i = 0; i < count; ++i) {
    const Bytes bytes = random_bytes(layout, random);
    Pod pod;
    layout.unpack(std::as_bytes(std::span(bytes)), &pod);
    CPod c_pod;
    c_unpack(bytes.data(), &c_pod);
    Bytes again(bytes.size());
    Bytes c_again(bytes.size());
    layout.pack(&pod, as_bytes(again));
    c_pack(&c_pod, c_again.data());
    const auto frame = output.make(&pod, Nanoseconds(i));
    Bytes c_bytes(frame.size());
    header.stamp = i;
    c_frame(&c_pod, &header, c_bytes.data());
    const bool is_same = again == bytes && c_again == bytes &&
                         std::memcmp(frame.data(), c_bytes.data(), frame.size()) == 0;
    different += is_same ? 0 : 1;
  }
  EXPECT_EQ(different, 0);
}

TEST(CBus, TheBytesOfABusAreThoseOfTheCppCodec) {
  expect_same_bytes<experimental::arm::State>(
      &experimental_arm_State_pack, &experimental_arm_State_unpack, &experimental_arm_State_frame,
      experimental_arm_State_HASH, 100'000);
}

TEST(CBus, AndSoForEachNumberThereIs) {
  expect_same_bytes<experimental::motion::Numbers>(
      &experimental_motion_Numbers_pack, &experimental_motion_Numbers_unpack,
      &experimental_motion_Numbers_frame, experimental_motion_Numbers_HASH, 100'000);
}

TEST(CBus, TheTableOfSignalsIsALayout) {
  std::vector<SignalEntry> entries;
  for (const rr_bus_signal& signal : experimental_arm_State_signals) {
    entries.push_back({.name = signal.name,
                       .type = static_cast<SignalType>(signal.type),
                       .count = signal.count,
                       .offset = signal.offset});
  }
  const Layout c_layout("experimental.arm.State", entries, sizeof(experimental_arm_State));
  const Layout layout = layout_of<experimental::arm::State>();
  EXPECT_EQ(c_layout.hash(), layout.hash());
  EXPECT_EQ(c_layout.packed_size(), experimental_arm_State_BYTES);
  for (const rr_bus_signal& signal : experimental_arm_State_signals) {
    EXPECT_EQ(layout.find(signal.name)->place, signal.place) << signal.name;
  }
}

TEST(CBus, FramesOfCppAreReadAndOldAndDamagedOnesAreNot) {
  StateOutput output(layout_of<experimental::arm::Command>(), 3);
  const experimental::arm::Command command{.mode = 5, .target = {1, 2, 3, 4, 5, 6}};
  Bytes first(experimental_arm_Command_FRAME_BYTES);
  Bytes second(first.size());
  const auto copy = [&](Bytes& to) {
    std::memcpy(to.data(), output.make(&command, Nanoseconds(9)).data(), to.size());
  };
  copy(first);
  copy(second);
  experimental_arm_Command bus{};
  rr_bus_frame header{};
  rr_bus_order order{};
  const auto receive = [&](const Bytes& frame) {
    return experimental_arm_Command_receive(&bus, &header, &order, frame.data(),
                                            static_cast<std::uint32_t>(frame.size()));
  };
  EXPECT_EQ(receive(second), 1);
  EXPECT_EQ(bus.target[5], 6);
  EXPECT_EQ(header.sequence, 1U);
  EXPECT_EQ(header.stamp, 9);
  EXPECT_EQ(receive(second), 0) << "a second time";
  EXPECT_EQ(receive(first), 0) << "older";
  copy(first);
  for (std::size_t i = 0; i < first.size(); ++i) {
    Bytes bad = first;
    bad[i] ^= 0x10;
    EXPECT_EQ(receive(bad), 0) << i;
    EXPECT_EQ(receive(Bytes(first.begin(), first.begin() + static_cast<std::ptrdiff_t>(i))), 0);
  }
  EXPECT_EQ(receive(first), 1);
}

// What boards do that have doubles of four bytes, tried against the hardware's conversion.
TEST(CBus, DoublesBecomeFloatsAndBackAsTheMachineDoesIt) {
  std::mt19937_64 random(8);
  const auto bits_of = [](auto number, auto bits) {
    std::memcpy(&bits, &number, sizeof bits);
    return bits;
  };
  int different = 0;
  for (int i = 0; i < 200'000; ++i) {
    // Half of them near the range of floats, where it is decided.
    std::uint64_t bits = random();
    if (i % 2 == 0) {
      bits = (bits & ~(std::uint64_t{0x7FF} << 52U)) | (random() % 300 + 870) << 52U;
    }
    double number = 0;
    std::memcpy(&number, &bits, sizeof number);
    if (!std::isnan(number)) {
      const auto expected = bits_of(static_cast<float>(number), std::uint32_t{});
      different += rr_bus_narrow(bits) == expected ? 0 : 1;
    }
    const auto narrow = static_cast<std::uint32_t>(random());
    float small = 0;
    std::memcpy(&small, &narrow, sizeof small);
    if (!std::isnan(small)) {
      const auto wide = bits_of(static_cast<double>(small), std::uint64_t{});
      different += rr_bus_widen(narrow) == wide && rr_bus_narrow(wide) == narrow ? 0 : 1;
    }
  }
  EXPECT_EQ(different, 0);
  EXPECT_EQ(rr_bus_narrow(0x7FF0000000000000U), 0x7F800000U);
  EXPECT_EQ(rr_bus_narrow(0x7FF8000000000000U) & 0x7FC00000U, 0x7FC00000U);
  EXPECT_EQ(rr_bus_widen(0x80000001U), 0xB6A0000000000000U);
}

}  // namespace
}  // namespace rr::realtime
