// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <memory>
#include <system_error>

#include "runtime/cpp/src/channel/passed_slots.hpp"

namespace rr::channel {
namespace {

class PassedSlotsTest : public ::testing::Test {
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
  PassedSlots passed_;
};

TEST_F(PassedSlotsTest, AreTakenByTheirNumbers) {
  for (const std::uint64_t id : {7U, 8U, 9U}) passed_.add(make(id)->handle());
  EXPECT_EQ(passed_.size(), 3U);
  const auto eight = passed_.take(8);
  ASSERT_NE(eight, nullptr);
  EXPECT_EQ(eight->id(), 8U);
  EXPECT_EQ(passed_.take(8), nullptr);
  EXPECT_EQ(passed_.take(10), nullptr);
  EXPECT_EQ(passed_.size(), 2U);
}

TEST_F(PassedSlotsTest, WhatIsNoneIsDropped) {
  std::error_code error;
  platform::Descriptor handle;
  const auto rings = platform::make_shared_memory(8192, handle, error);
  passed_.add(handle);
  passed_.add(platform::Descriptor());
  const auto empty = platform::make_published_memory(8192, handle, error);
  passed_.add(handle);
  EXPECT_EQ(passed_.size(), 0U);
}

TEST_F(PassedSlotsTest, AreNeverTooMany) {
  for (std::uint64_t id = 1; id <= PassedSlots::most + 2; ++id) passed_.add(make(id)->handle());
  EXPECT_EQ(passed_.size(), PassedSlots::most);
  EXPECT_EQ(passed_.take(1), nullptr);
  EXPECT_EQ(passed_.take(2), nullptr);
  EXPECT_NE(passed_.take(3), nullptr);
}

}  // namespace
}  // namespace rr::channel
