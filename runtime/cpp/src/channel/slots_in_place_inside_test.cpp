// SPDX-License-Identifier: Apache-2.0
// Large arrays that are read in their slot, and readers that use slots for longer than they may.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "runtime/cpp/src/channel/shared_header.hpp"
#include "runtime/cpp/src/channel/shared_rings.hpp"
#include "runtime/cpp/src/channel/wire_slots.hpp"

namespace rr::channel {
namespace {

using ::testing::Each;
using Found = SlotReader::Found;

constexpr std::size_t array_size = 100'000;
constexpr std::size_t before_array = 21;
constexpr std::size_t behind_array = 5;

class SlotsInPlace : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!platform::has_shared_memory()) GTEST_SKIP() << "this system has no shared memory";
    std::error_code error;
    platform::Descriptor handle;
    rings_.emplace(SharedRings::make(SharedRings::smallest_ring, handle, error));
    ASSERT_TRUE(*rings_) << error.message();
    pool_.emplace(rings_->holds());
    writer_ = SlotWriter::make(SlotSizes::for_value(array_size + 100), 42, error);
    ASSERT_NE(writer_, nullptr) << error.message();
    reader_ = open();
  }

  // A reader whose words the writer looks at.
  std::unique_ptr<SlotReader> open() {
    std::error_code error;
    auto reader = SlotReader::open(writer_->handle(), error);
    drawn_.push_back(pool_->draw());
    writer_->add_holds(drawn_.back());
    reader->use_holds(std::make_shared<SlotHolds>(words(drawn_.back()->place())));
    return reader;
  }
  std::shared_ptr<SlotHolds::Words> words(std::uint32_t place) {
    const auto first = rings_->holds();
    return {first, first.get() + place};
  }

  // Some bytes, the items of an array, and some bytes more, each of them `byte`.
  bool publish(int byte, std::size_t items = array_size) {
    const std::vector<std::byte> bytes(before_array + items + behind_array,
                                       static_cast<std::byte>(byte));
    const std::array<Piece, 3> pieces{Piece{bytes.data(), before_array},
                                      Piece{bytes.data() + before_array, items, true},
                                      Piece{bytes.data() + before_array + items, behind_array}};
    return writer_->publish(pieces, bytes.size(), ++time_);
  }
  static std::span<const std::byte> items_of(const SlotValue& value) {
    if (value.displaced.size() != 1) return {};
    return {value.displaced.front().items, value.displaced.front().gap.size()};
  }

  std::int64_t time_ = 0;
  std::optional<SharedRings> rings_;
  std::optional<HoldPool> pool_;
  std::vector<std::shared_ptr<ServedHolds>> drawn_;
  std::unique_ptr<SlotWriter> writer_;
  std::unique_ptr<SlotReader> reader_;
};

// The steps alone.
TEST(UsedSlots, AreNotBegun) {
  using Steps = SlotSteps<Synchronization>;
  Steps::Words words;
  Steps::Head head;
  HoldWords<Synchronization> holds;
  const auto is_used = [&] { return holds.are_used(1); };
  Steps::begin(head, 5);
  Steps::commit(words, head, 5);
  holds.use(1, 5);
  EXPECT_EQ(Steps::look_at_used(head, 5, 4), Steps::State::whole);
  EXPECT_FALSE(Steps::try_to_begin(head, 9, is_used));
  EXPECT_EQ(head.sequence, 10U) << "as it was";
  holds.leave(1);
  EXPECT_TRUE(Steps::try_to_begin(head, 9, is_used));
  EXPECT_EQ(head.sequence, 17U);
  EXPECT_EQ(Steps::look_at_used(head, 5, 4), Steps::State::later);
}

TEST(UsedSlots, RunsArePacked) {
  const SlotRun run{.begin = 0x12345678, .size = 0x9ABCDEF0};
  EXPECT_EQ(run.packed(), 0x12345678'9ABCDEF0U);
  EXPECT_EQ(SlotRun::unpack(run.packed()).begin, run.begin);
  EXPECT_EQ(SlotRun::unpack(run.packed()).size, run.size);
}

TEST_F(SlotsInPlace, TheItemsOfALargeArrayAreNotCopied) {
  ASSERT_TRUE(publish(7));
  SlotValue value;
  ASSERT_EQ(reader_->read(value), Found::value);
  EXPECT_EQ(value.bytes.size(), before_array + array_size + behind_array);
  EXPECT_THAT(value.bytes.first(before_array), Each(std::byte{7}));
  EXPECT_THAT(value.bytes.last(behind_array), Each(std::byte{7}));
  ASSERT_EQ(items_of(value).size(), array_size);
  EXPECT_THAT(items_of(value), Each(std::byte{7}));
  EXPECT_EQ(value.displaced.front().gap.data(), value.bytes.data() + before_array);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(items_of(value).data()) % 64, 0U);
  EXPECT_TRUE(value.slot);
  EXPECT_FALSE(value.slot.is_unique()) << "nobody may write to it";
  EXPECT_EQ(drawn_.front()->count(), 1U);
  EXPECT_TRUE(drawn_.front()->has(1)) << "the first value is in slot 1";
  value.slot = {};
  EXPECT_EQ(drawn_.front()->count(), 0U);
}

TEST_F(SlotsInPlace, AValueStaysForAsLongAsItIsUsed) {
  ASSERT_TRUE(publish(1));
  SlotValue kept;
  ASSERT_EQ(reader_->read(kept), Found::value);
  const auto items = items_of(kept);
  SlotValue value;
  for (int i = 2; i < 30; ++i) {
    ASSERT_TRUE(publish(i));
    ASSERT_EQ(reader_->read(value), Found::value) << i;
    EXPECT_EQ(items_of(value).back(), static_cast<std::byte>(i));
    EXPECT_THAT(items, Each(std::byte{1})) << i;
  }
}

TEST_F(SlotsInPlace, AReaderUsesTwoAndCopiesTheOthers) {
  std::vector<SlotValue> values(3);
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(publish(i + 1));
    ASSERT_EQ(reader_->read(values[static_cast<std::size_t>(i)]), Found::value);
  }
  EXPECT_TRUE(values[1].slot);
  EXPECT_FALSE(values[2].slot);
  EXPECT_TRUE(values[2].owner) << "it has memory that arrays may be parts of";
  EXPECT_THAT(values[2].bytes, Each(std::byte{3}));
  values[0].slot = {};
  ASSERT_TRUE(publish(4));
  ASSERT_EQ(reader_->read(values[2]), Found::value);
  EXPECT_TRUE(values[2].slot);
}

// A thread may still decode it.
TEST_F(SlotsInPlace, AValueOutlivesItsReaderAndTheNextValues) {
  ASSERT_TRUE(publish(1));
  SlotValue value;
  ASSERT_EQ(reader_->read(value), Found::value);
  ASSERT_TRUE(publish(2));
  SlotValue next;
  ASSERT_EQ(reader_->read(next), Found::value);
  reader_.reset();
  writer_.reset();
  EXPECT_THAT(value.bytes.first(before_array), Each(std::byte{1}));
  EXPECT_THAT(items_of(value), Each(std::byte{1}));
  EXPECT_THAT(next.bytes.last(behind_array), Each(std::byte{2}));
  EXPECT_THAT(items_of(next), Each(std::byte{2}));
}

TEST_F(SlotsInPlace, SmallArraysAreCopied) {
  ASSERT_TRUE(publish(1, 60'000));
  SlotValue value;
  ASSERT_EQ(reader_->read(value), Found::value);
  EXPECT_TRUE(value.displaced.empty());
  EXPECT_FALSE(value.slot);
  EXPECT_EQ(drawn_.front()->count(), 0U);
}

TEST_F(SlotsInPlace, AReaderWithoutWordsCopies) {
  std::error_code error;
  const auto reader = SlotReader::open(writer_->handle(), error);
  ASSERT_TRUE(publish(5));
  SlotValue value;
  ASSERT_EQ(reader->read(value), Found::value);
  EXPECT_TRUE(value.displaced.empty());
  EXPECT_THAT(value.bytes, Each(std::byte{5}));
}

TEST_F(SlotsInPlace, AValueWithoutASlotIsRefusedAndTheNextOneIsNot) {
  std::vector<std::unique_ptr<SlotReader>> readers;
  std::vector<SlotValue> values(writer_->sizes().count);
  // Each reader uses another value, the last one the newest.
  for (std::size_t i = 0; i < values.size(); ++i) {
    ASSERT_TRUE(publish(static_cast<int>(i) + 1)) << i;
    readers.push_back(open());
    ASSERT_EQ(readers.back()->read(values[i]), Found::value);
    ASSERT_TRUE(values[i].slot);
  }
  EXPECT_FALSE(publish(99));
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_THAT(items_of(values[i]), Each(static_cast<std::byte>(i + 1)));
  }
  SlotValue value;
  EXPECT_EQ(readers.back()->read(value), Found::nothing);
  values[2].slot = {};
  EXPECT_TRUE(publish(100));
  ASSERT_EQ(readers.back()->read(value), Found::value);
  EXPECT_THAT(items_of(value), Each(std::byte{100}));
}

TEST_F(SlotsInPlace, AGreedyReaderIsNoLongerListenedTo) {
  ASSERT_TRUE(publish(1));
  const auto all = words(drawn_.front()->place());
  for (std::size_t slot = 0; slot < most_slots; ++slot) all->use(slot, 1);
  int refused = 0;
  while (!publish(2) && refused < 1000) ++refused;
  EXPECT_EQ(refused, 16);
  EXPECT_TRUE(publish(3));
}

TEST_F(SlotsInPlace, AReaderThatHasLeftUsesNothing) {
  ASSERT_TRUE(publish(1));
  const auto all = words(drawn_.front()->place());
  for (std::size_t slot = 0; slot < most_slots; ++slot) all->use(slot, 1);
  EXPECT_FALSE(publish(2));
  writer_->remove_holds(*drawn_.front());
  EXPECT_TRUE(publish(3));
}

// The head of the slot of the first value.
SlotHead<Synchronization>& head_of(const platform::SharedMemory& memory) {
  return *std::launder(reinterpret_cast<SlotHead<Synchronization>*>(memory.bytes() + 0x200 + 64));
}

TEST_F(SlotsInPlace, WhatTheHeadSaysIsChecked) {
  const std::size_t slot = 128 * 1024;
  const auto packed = [](std::size_t begin, std::size_t size) {
    return SlotRun{static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(size)}.packed();
  };
  struct Case {
    std::uint32_t begin;
    std::uint32_t run_count;
    std::array<std::uint64_t, 4> runs;
    bool is_right;
  };
  const std::size_t size = 100'000;
  const std::array<Case, 10> cases{{
      {0, 1, {packed(10, 70'000)}, true},
      {64, 1, {packed(0, size)}, true},
      {static_cast<std::uint32_t>(slot - size), 0, {}, true},
      {static_cast<std::uint32_t>(slot - size + 1), 0, {}, false},
      {0xFFFF'FFFF, 0, {}, false},
      {0, 5, {}, false},
      {0, 1, {packed(10, size - 9)}, false},
      {0, 1, {packed(size + 1, 0)}, false},
      {0, 2, {packed(10, 100), packed(109, 100)}, false},
      {0, 4, {packed(0, 10), packed(10, 10), packed(20, 0), packed(size, 0)}, true},
  }};
  for (const Case& one : cases) {
    std::error_code error;
    platform::Descriptor handle;
    const auto memory = platform::make_published_memory(0x1000 + 2 * slot, handle, error);
    ASSERT_TRUE(memory) << error.message();
    SharedHeader header = SharedHeader::of(SharedKind::slots, slot);
    header.area_count = 2;
    std::memcpy(memory.bytes(), &header, sizeof header);
    auto& head = head_of(memory);
    head.sequence = 2;
    head.size = size;
    head.begin = one.begin;
    head.run_count = one.run_count;
    for (std::size_t i = 0; i < one.runs.size(); ++i) head.runs[i] = one.runs[i];
    reinterpret_cast<std::atomic<std::uint64_t>*>(memory.bytes() + 0x100)->store(1);
    for (const bool uses_words : {false, true}) {
      const auto reader = SlotReader::open(handle, error);
      ASSERT_NE(reader, nullptr) << error.message();
      if (uses_words) reader->use_holds(std::make_shared<SlotHolds>(words(7)));
      SlotValue value;
      EXPECT_EQ(reader->read(value), one.is_right ? Found::value : Found::wrong)
          << one.begin << " " << one.run_count << " " << uses_words;
    }
  }
}

TEST_F(SlotsInPlace, WordsAreDrawnUntilThereAreNone) {
  std::vector<std::shared_ptr<ServedHolds>> drawn;
  for (std::size_t i = 1; i < HoldPlaces::count; ++i) {
    drawn.push_back(pool_->draw());
    ASSERT_NE(drawn.back(), nullptr);
    EXPECT_EQ(drawn.back()->place(), i);
  }
  EXPECT_EQ(pool_->draw(), nullptr);
  drawn[4].reset();
  drawn[4] = pool_->draw();
  EXPECT_EQ(drawn[4]->place(), 5U);
}

TEST_F(SlotsInPlace, WordsOfAnotherReaderAreNotChangedByWhoHadThemBefore) {
  const auto place = words(3);
  SlotHolds before(place);
  EXPECT_TRUE(before.hold(1, 10));
  EXPECT_FALSE(before.hold(1, 20)) << "the service has written over what is used";
  before.detach();
  SlotHolds now(place);
  EXPECT_FALSE(place->are_used(1));
  EXPECT_TRUE(now.hold(1, 30));
  before.release(1);
  EXPECT_FALSE(before.hold(2, 40));
  EXPECT_EQ(place->numbers[1], 30U);
  EXPECT_FALSE(place->are_used(2));
}

}  // namespace
}  // namespace rr::channel
