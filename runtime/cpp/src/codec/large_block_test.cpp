// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/codec/large_block.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <new>
#include <vector>

#include "rr/buffer.hpp"
#include "rr/writer.hpp"

namespace rr::codec {
namespace {

constexpr std::size_t mib = std::size_t{1024} * 1024;

class LargeBlocks : public testing::Test {
 protected:
  LargeBlocks() { drop_spare_blocks(); }
  ~LargeBlocks() override { drop_spare_blocks(); }
};

TEST_F(LargeBlocks, AreWholePages) {
  const LargeBlock block = take_large_block(mib + 1);
  EXPECT_EQ(block.size, mib + 4096);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(block.bytes) % 4096, 0U);
  std::memset(block.bytes, 1, block.size);
  give_back_large_block(block);
}

TEST_F(LargeBlocks, AreTakenAgain) {
  const LargeBlock first = take_large_block(mib);
  give_back_large_block(first);
  EXPECT_EQ(spare_block_bytes(), mib);
  const LargeBlock second = take_large_block(mib - 4096);
  EXPECT_EQ(second.bytes, first.bytes);
  EXPECT_EQ(second.size, mib);
  EXPECT_EQ(spare_block_bytes(), 0U);
  give_back_large_block(second);
}

TEST_F(LargeBlocks, AreNotTakenForMuchLess) {
  const LargeBlock first = take_large_block(2 * mib);
  give_back_large_block(first);
  const LargeBlock second = take_large_block(mib);
  EXPECT_EQ(second.size, mib);
  EXPECT_EQ(spare_block_bytes(), 2 * mib);
  give_back_large_block(second);
}

TEST_F(LargeBlocks, OfLargeSizeAreNotKept) {
  give_back_large_block(take_large_block(most_spare_bytes + 1));
  EXPECT_EQ(spare_block_bytes(), 0U);
}

TEST_F(LargeBlocks, GiveWayToLaterOnes) {
  std::vector<LargeBlock> blocks;
  for (int i = 0; i < 20; ++i) blocks.push_back(take_large_block(mib));
  for (const LargeBlock& block : blocks) give_back_large_block(block);
  EXPECT_EQ(spare_block_bytes(), 8 * mib);
  give_back_large_block(take_large_block(10 * mib));
  EXPECT_LE(spare_block_bytes(), most_spare_bytes);
  EXPECT_GE(spare_block_bytes(), 10 * mib);
  give_back_large_block(take_large_block(most_spare_bytes));
  EXPECT_EQ(spare_block_bytes(), most_spare_bytes);
}

TEST_F(LargeBlocks, ThatNobodyTakesGoBack) {
  give_back_large_block(take_large_block(mib));
  EXPECT_TRUE(age_spare_blocks());
  EXPECT_EQ(spare_block_bytes(), mib);
  give_back_large_block(take_large_block(2 * mib));
  EXPECT_TRUE(age_spare_blocks());  // of the one that came later
  EXPECT_EQ(spare_block_bytes(), 2 * mib);
  EXPECT_FALSE(age_spare_blocks());
  EXPECT_EQ(spare_block_bytes(), 0U);
}

TEST_F(LargeBlocks, ThatAreUsedAgainStay) {
  for (int i = 0; i < 3; ++i) {
    give_back_large_block(take_large_block(mib));
    EXPECT_TRUE(age_spare_blocks());
    EXPECT_EQ(spare_block_bytes(), mib);
  }
}

TEST_F(LargeBlocks, ThatCannotBeHadAreAnError) {
  EXPECT_THROW(take_large_block(SIZE_MAX - 5), std::bad_alloc);
  EXPECT_THROW(take_large_block(SIZE_MAX / 2), std::bad_alloc);
}

#if !defined(__SANITIZE_ADDRESS__)
TEST_F(LargeBlocks, HoldLargeAllocations) {
  allocate(4 * mib);
  EXPECT_GE(spare_block_bytes(), 4 * mib);
  drop_spare_blocks();
  EXPECT_EQ(spare_block_bytes(), 0U);
}

TEST_F(LargeBlocks, OfAWriterAreNotKeptForTheNextMessage) {
  Writer writer;
  writer.reset(MessageVersion::v4);
  std::memset(writer.prepend(4 * mib), 0, 4 * mib);
  EXPECT_LT(spare_block_bytes(), 4 * mib);
  writer.reset(MessageVersion::v4);
  EXPECT_GE(spare_block_bytes(), 4 * mib);
}
#endif

}  // namespace
}  // namespace rr::codec
