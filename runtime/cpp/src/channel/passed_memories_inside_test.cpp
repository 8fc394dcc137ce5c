// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <memory>
#include <system_error>

#include "runtime/cpp/src/channel/passed_memories.hpp"

namespace rr::channel {
namespace {

class PassedMemoriesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!platform::has_shared_memory()) GTEST_SKIP() << "this system has no shared memory";
  }
  static std::unique_ptr<SlotWriter> make(std::uint64_t id) {
    std::error_code error;
    auto writer = SlotWriter::make(SlotSizes::for_value(100), id, error);
    EXPECT_NE(writer, nullptr) << error.message();
    return writer;
  }
  PassedMemories passed_;
};

TEST_F(PassedMemoriesTest, AreTakenByTheirNumbers) {
  for (const std::uint64_t id : {7U, 8U, 9U}) passed_.add(make(id)->handle());
  EXPECT_EQ(passed_.size(), 3U);
  const auto eight = passed_.take_slots(8);
  ASSERT_NE(eight, nullptr);
  EXPECT_EQ(eight->id(), 8U);
  EXPECT_EQ(passed_.take_slots(8), nullptr);
  EXPECT_EQ(passed_.take_slots(10), nullptr);
  EXPECT_EQ(passed_.size(), 2U);
}

TEST_F(PassedMemoriesTest, AreOfTwoKinds) {
  std::error_code error;
  const auto ring = PipeRingWriter::make(PipeRingSize::for_packet(100), 8, error);
  ASSERT_NE(ring, nullptr) << error.message();
  passed_.add(make(7)->handle());
  passed_.add(ring->handle());
  EXPECT_EQ(passed_.take_ring(7), nullptr);
  EXPECT_EQ(passed_.take_slots(8), nullptr);
  const auto taken = passed_.take_ring(8);
  ASSERT_NE(taken, nullptr);
  EXPECT_EQ(taken->id(), 8U);
  EXPECT_NE(passed_.take_slots(7), nullptr);
  EXPECT_EQ(passed_.size(), 0U);
}

TEST_F(PassedMemoriesTest, WhatIsNoneIsDropped) {
  std::error_code error;
  platform::Descriptor handle;
  const auto rings = platform::make_shared_memory(8192, handle, error);
  passed_.add(handle);
  passed_.add(platform::Descriptor());
  const auto empty = platform::make_published_memory(8192, handle, error);
  passed_.add(handle);
  EXPECT_EQ(passed_.size(), 0U);
}

TEST_F(PassedMemoriesTest, AreNeverTooMany) {
  for (std::uint64_t id = 1; id <= PassedMemories::most + 2; ++id) passed_.add(make(id)->handle());
  EXPECT_EQ(passed_.size(), PassedMemories::most);
  EXPECT_EQ(passed_.take_slots(1), nullptr);
  EXPECT_EQ(passed_.take_slots(2), nullptr);
  EXPECT_NE(passed_.take_slots(3), nullptr);
}

}  // namespace
}  // namespace rr::channel
