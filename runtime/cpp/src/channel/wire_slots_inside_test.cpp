// SPDX-License-Identifier: Apache-2.0
// Publishers and readers of one memory in one process, and publishers that do not keep to the
// rules.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstring>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "runtime/cpp/src/channel/shared_header.hpp"
#include "runtime/cpp/src/channel/wire_slots.hpp"

namespace rr::channel {
namespace {

using std::chrono_literals::operator""h;
using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using Found = SlotReader::Found;

class WireSlots : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!platform::has_shared_memory()) GTEST_SKIP() << "this system has no shared memory";
  }
  void make(std::size_t value_size = 100) {
    std::error_code error;
    writer_ = SlotWriter::make(SlotSizes::for_value(value_size), 42, error);
    ASSERT_NE(writer_, nullptr) << error.message();
    reader_ = open();
  }
  [[nodiscard]] std::unique_ptr<SlotReader> open() const {
    std::error_code error;
    auto reader = SlotReader::open(writer_->handle(), error);
    EXPECT_NE(reader, nullptr) << error.message();
    return reader;
  }
  bool publish(std::string_view text) {
    const Piece piece{reinterpret_cast<const std::byte*>(text.data()), text.size()};
    return writer_->publish({&piece, 1}, text.size(), ++time_);
  }
  static std::string text_of(const SlotValue& value) {
    return {reinterpret_cast<const char*>(value.bytes.data()), value.bytes.size()};
  }
  static std::string read(SlotReader& reader) {
    SlotValue value;
    switch (reader.read(value)) {
      case Found::nothing:
        return "nothing";
      case Found::wrong:
        return "wrong";
      default:
        return text_of(value);
    }
  }

  std::int64_t time_ = 0;
  std::unique_ptr<SlotWriter> writer_;
  std::unique_ptr<SlotReader> reader_;
};

// The steps alone, of a publisher that is stopped between them.
TEST(SlotSteps, ASlotIsWholeOnceItIsCommitted) {
  using Steps = SlotSteps<Synchronization>;
  Steps::Words words;
  Steps::Head head;
  Steps::begin(head, 5);
  EXPECT_EQ(head.sequence, 9U);
  EXPECT_EQ(words.newest, 0U) << "nobody looks there yet";
  Steps::commit(words, head, 5);
  EXPECT_EQ(words.newest, 5U);
  EXPECT_EQ(words.bell, 1U);
  EXPECT_EQ(Steps::look(head, 5, 4), Steps::State::whole);
  EXPECT_EQ(Steps::look_again(head, 5, 4), Steps::State::whole);
  Steps::begin(head, 9);
  EXPECT_EQ(Steps::look(head, 5, 4), Steps::State::later);
  EXPECT_EQ(Steps::look_again(head, 5, 4), Steps::State::later);
  EXPECT_EQ(Steps::look(head, 9, 4), Steps::State::wrong) << "it is not the newest yet";
  EXPECT_EQ(Steps::look(head, 6, 4), Steps::State::wrong) << "of another slot";
  Steps::ring(words);
  EXPECT_EQ(words.bell, 2U);
  Steps::end(words);
  EXPECT_EQ(words.is_over, 1U);
  EXPECT_EQ(words.bell, 3U);
}

TEST(SlotSteps, FencesKeepWhatIsOnEachSideOfThem) {
  std::atomic<int> value{0};
  std::atomic<int> flag{0};
  std::thread writer([&] {
    value.store(42, std::memory_order_relaxed);
    Synchronization::fence_release();
    flag.store(1, std::memory_order_relaxed);
  });
  while (flag.load(std::memory_order_relaxed) == 0) std::this_thread::yield();
  Synchronization::fence_acquire();
  EXPECT_EQ(value.load(std::memory_order_relaxed), 42);
  writer.join();
}

TEST_F(WireSlots, AHeaderIsOfOneKind) {
  const SharedHeader header = SharedHeader::of(SharedKind::slots, 8192);
  EXPECT_EQ(header.area_size, 8192U);
  EXPECT_TRUE(header.is_of(SharedKind::slots));
  EXPECT_FALSE(header.is_of(SharedKind::rings));
  for (const std::size_t size : {SharedHeader::first_data, SharedHeader::first_data - 1}) {
    platform::Descriptor handle;
    std::error_code error;
    const auto memory = platform::make_shared_memory(size, handle, error);
    ASSERT_TRUE(memory);
    std::memcpy(memory.bytes(), &header, sizeof header);
    const bool has_data = size == SharedHeader::first_data;
    EXPECT_EQ(SharedHeader::read(memory).is_of(SharedKind::slots), has_data);
  }
}

TEST(SlotSizes, HaveRoomForSomewhatLargerValues) {
  EXPECT_EQ(SlotSizes::for_value(0).slot, SlotSizes::smallest_slot);
  EXPECT_EQ(SlotSizes::for_value(200).memory(), 4096U + 4 * 4096U);
  const SlotSizes picture = SlotSizes::for_value(10'000'000);
  EXPECT_GE(picture.slot, 12'500'000U);
  EXPECT_EQ(picture.count, 5U);
  EXPECT_TRUE(picture.are_right());
  EXPECT_TRUE(picture.are_large());
  EXPECT_FALSE(SlotSizes::for_value(50'000).are_large());
  EXPECT_EQ(SlotSizes::for_value(SlotSizes::largest_slot).slot, SlotSizes::largest_slot);
  EXPECT_EQ(SlotSizes::for_value(SlotSizes::largest_slot + 1).slot, 0U);
  EXPECT_FALSE(SlotSizes::for_value(SlotSizes::largest_slot + 1).are_right());
}

TEST(SlotSizes, AreCheckedAsAHeaderSaysThem) {
  EXPECT_TRUE((SlotSizes{4096, 2}.are_right()));
  EXPECT_TRUE((SlotSizes{SlotSizes::largest_slot, most_slots}.are_right()));
  EXPECT_FALSE((SlotSizes{4096, 1}.are_right()));
  EXPECT_FALSE((SlotSizes{4096, most_slots + 1}.are_right()));
  EXPECT_FALSE((SlotSizes{4096 + 64, 4}.are_right()));
  EXPECT_FALSE((SlotSizes{SlotSizes::largest_slot + 4096, 4}.are_right()));
}

TEST_F(WireSlots, AreNotMadeInOtherSizes) {
  std::error_code error;
  EXPECT_EQ(SlotWriter::make({100, 4}, 1, error), nullptr);
  EXPECT_EQ(error, std::errc::invalid_argument);
}

TEST_F(WireSlots, EachReaderGetsTheNewestValueOnce) {
  make();
  EXPECT_TRUE(writer_->is_empty());
  EXPECT_EQ(reader_->id(), 42U);
  EXPECT_EQ(writer_->id(), 42U);
  EXPECT_EQ(reader_->sizes().slot, writer_->sizes().slot);
  EXPECT_EQ(read(*reader_), "nothing");
  EXPECT_TRUE(publish("one"));
  EXPECT_FALSE(writer_->is_empty());
  EXPECT_EQ(read(*reader_), "one");
  EXPECT_EQ(read(*reader_), "nothing");
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(publish("value " + std::to_string(i)));
  const auto late = open();
  EXPECT_EQ(read(*late), "value 19");
  EXPECT_EQ(read(*reader_), "value 19");
  EXPECT_EQ(read(*reader_), "nothing");
}

TEST_F(WireSlots, ValuesMayHaveSeveralPieces) {
  make();
  const std::string_view text = "firstsecond";
  const auto* const bytes = reinterpret_cast<const std::byte*>(text.data());
  const std::array<Piece, 3> pieces{Piece{bytes, 5}, Piece{}, Piece{bytes + 5, 6}};
  EXPECT_TRUE(writer_->publish(pieces, text.size(), 1));
  EXPECT_EQ(read(*reader_), text);
}

TEST_F(WireSlots, AnOlderValueIsDropped) {
  make();
  time_ = 10;
  EXPECT_TRUE(publish("new"));
  time_ = 5;
  EXPECT_TRUE(publish("old"));
  EXPECT_EQ(read(*reader_), "new");
}

TEST_F(WireSlots, AValueMayFillItsSlot) {
  make(50'000);
  const std::string most(writer_->sizes().slot, 'x');
  EXPECT_TRUE(publish(most));
  EXPECT_FALSE(publish(most + "x"));
  SlotValue value;
  ASSERT_EQ(reader_->read(value), Found::value);
  EXPECT_EQ(text_of(value), most);
  EXPECT_TRUE(value.owner) << "it has memory that arrays may be parts of";
  EXPECT_TRUE(publish("small"));
  ASSERT_EQ(reader_->read(value), Found::value);
  EXPECT_FALSE(value.owner);
}

TEST_F(WireSlots, SayWhenAValueWasPublished) {
  make();
  const Time before = Clock::now();
  publish("one");
  const Time after = Clock::now();
  SlotValue value;
  ASSERT_EQ(reader_->read(value), Found::value);
  EXPECT_GE(value.published, before);
  EXPECT_LE(value.published, after);
}

TEST_F(WireSlots, EndAndKeepTheLastValue) {
  make();
  publish("last");
  const std::uint32_t bell = reader_->bell();
  EXPECT_FALSE(reader_->is_over());
  writer_->end();
  EXPECT_TRUE(reader_->is_over());
  EXPECT_NE(reader_->bell(), bell);
  writer_.reset();
  EXPECT_EQ(read(*reader_), "last");
}

TEST_F(WireSlots, AReaderSleepsUntilThereIsAValue) {
  make();
  for (int round = 0; round < 50; ++round) {
    std::thread publisher([&] {
      writer_->add_sleeper();
      publish("value");
      writer_->remove_sleeper();
    });
    std::string text;
    while (true) {
      const std::uint32_t bell = reader_->bell();
      text = read(*reader_);
      if (text != "nothing") break;
      reader_->sleep(bell, 20s);
    }
    EXPECT_EQ(text, "value");
    publisher.join();
  }
}

// Whoever sleeps before the publisher knows of it is woken to look again.
TEST_F(WireSlots, ASleeperIsWokenWhenItIsCounted) {
  make();
  const std::uint32_t bell = reader_->bell();
  std::atomic<bool> is_awake{false};
  std::thread sleeper([&] {
    reader_->sleep(bell, 20s);
    is_awake = true;
  });
  while (!is_awake) {
    std::this_thread::sleep_for(1ms);
    writer_->add_sleeper();
  }
  sleeper.join();
  EXPECT_NE(reader_->bell(), bell) << "it may have slept a moment later";
  EXPECT_EQ(read(*reader_), "nothing");
}

TEST_F(WireSlots, ASleepIsInterruptedAndEndsInTime) {
  make();
  const std::uint32_t bell = reader_->bell();
  reader_->sleep(bell, 5ms);
  reader_->interrupt();
  reader_->sleep(bell, 1h);  // at once
  std::atomic<bool> is_awake{false};
  std::thread sleeper([&] {
    reader_->sleep(bell, 20s);
    is_awake = true;
  });
  while (!is_awake) {
    reader_->interrupt();
    std::this_thread::sleep_for(1ms);
  }
  sleeper.join();
}

// Each value has one letter, so that one of two halves shows.
TEST_F(WireSlots, AValueIsNeverTornNorOlderThanTheOneBefore) {
  make(30'000);
  std::atomic<bool> is_over{false};
  std::thread publisher([&] {
    for (std::uint32_t i = 1; !is_over; ++i) {
      std::vector<std::uint32_t> words(1 + i % 7000, i);
      const Piece piece{reinterpret_cast<const std::byte*>(words.data()), words.size() * 4};
      writer_->publish({&piece, 1}, piece.size, i);
    }
  });
  std::vector<std::thread> readers;
  std::atomic<int> found{0};
  std::atomic<int> faults{0};
  for (int i = 0; i < 2; ++i) {
    readers.emplace_back([&] {
      const auto reader = open();
      SlotValue value;
      std::uint32_t last = 0;
      for (int got = 0; got < 300;) {
        const Found result = reader->read(value);
        if (result == Found::wrong) ++faults;
        if (result != Found::value) continue;
        ++got;
        std::vector<std::uint32_t> words(value.bytes.size() / 4);
        std::memcpy(words.data(), value.bytes.data(), words.size() * 4);
        const std::uint32_t number = words.at(0);
        if (number <= last || words.size() != 1 + number % 7000) ++faults;
        if (words != std::vector<std::uint32_t>(words.size(), number)) ++faults;
        last = number;
        ++found;
      }
    });
  }
  for (std::thread& reader : readers) reader.join();
  is_over = true;
  publisher.join();
  EXPECT_EQ(found, 600);
  EXPECT_EQ(faults, 0);
}

// A publisher that writes what it likes, where it likes.
class LyingPublisher : public ::testing::Test {
 protected:
  static constexpr std::size_t newest_at = 0x100;
  static constexpr std::size_t heads_at = 0x200;

  void SetUp() override {
    if (!platform::has_shared_memory()) GTEST_SKIP() << "this system has no shared memory";
    make();
  }
  void make(std::size_t size = 4096 + 4 * 4096) {
    std::error_code error;
    memory_ = platform::make_published_memory(size, handle_, error);
    ASSERT_TRUE(memory_) << error.message();
    std::memcpy(memory_.bytes(), "RRSHARED", 8);
    put<std::uint32_t>(8, 1);
    put<std::uint32_t>(12, 2);
    put<std::uint32_t>(16, 4096);
    put<std::uint32_t>(20, 4096);
    put<std::uint32_t>(24, 4);
    put<std::uint64_t>(32, 42);
  }
  template <class T>
  void put(std::size_t at, T value) {
    std::memcpy(memory_.bytes() + at, &value, sizeof value);
  }
  // As if value number `number` were in its slot.
  void put_value(std::uint64_t number, std::uint64_t sequence, std::uint64_t size) {
    const std::size_t head = heads_at + number % 4 * 64;
    put<std::uint64_t>(head, sequence);
    put<std::uint64_t>(head + 8, size);
    put<std::int64_t>(head + 16, 1);
    put<std::uint64_t>(newest_at, number);
  }
  [[nodiscard]] std::unique_ptr<SlotReader> open() const {
    std::error_code error;
    return SlotReader::open(handle_, error);
  }
  [[nodiscard]] Found read() const {
    SlotValue value;
    return open()->read(value);
  }

  platform::SharedMemory memory_;
  platform::Descriptor handle_;
};

TEST_F(LyingPublisher, IsBelievedWhileItKeepsToTheRules) {
  const auto reader = open();
  ASSERT_NE(reader, nullptr);
  EXPECT_EQ(reader->id(), 42U);
  SlotValue value;
  EXPECT_EQ(reader->read(value), Found::nothing);
  put_value(1, 2, 4096);
  EXPECT_EQ(reader->read(value), Found::value);
  EXPECT_EQ(value.bytes.size(), 4096U);
  put_value(1'000'000, 2'000'000, 0);
  EXPECT_EQ(reader->read(value), Found::value);
  EXPECT_TRUE(value.bytes.empty());
}

TEST_F(LyingPublisher, HeadersThatCannotBeAreRefused) {
  EXPECT_NE(open(), nullptr);
  for (const std::size_t at : {0U, 7U, 8U, 12U, 20U}) {
    make();
    memory_.bytes()[at] ^= std::byte{0x80};
    EXPECT_EQ(open(), nullptr) << at;
  }
  for (const std::uint32_t slot : {0U, 4095U, 8192U, 0x10000000U, 0xFFFFF000U, 0xFFFFFFFFU}) {
    make();
    put<std::uint32_t>(16, slot);
    EXPECT_EQ(open(), nullptr) << slot;
  }
  for (const std::uint32_t count : {0U, 1U, 3U, 5U, 9U, 0xFFFFFFFFU}) {
    make();
    put<std::uint32_t>(24, count);
    EXPECT_EQ(open(), nullptr) << count;
  }
  make(4096 + 4 * 4096 + 1);
  EXPECT_EQ(open(), nullptr);
  make(2048);
  EXPECT_EQ(open(), nullptr);
}

TEST_F(LyingPublisher, ASlotThatStaysOddIsFoundOut) {
  put_value(5, 9, 10);
  EXPECT_EQ(read(), Found::wrong);
}

TEST_F(LyingPublisher, SequencesOfOtherSlotsAreFoundOut) {
  for (const std::uint64_t sequence : {0U, 2U, 8U, 11U, 12U, 13U, 16U}) {
    put_value(5, sequence, 10);
    EXPECT_EQ(read(), Found::wrong) << sequence;
  }
  put_value(5, ~std::uint64_t{0}, 10);
  EXPECT_EQ(read(), Found::wrong);
}

// A later value is in the slot, so that there must be a newer one than that of the number.
TEST_F(LyingPublisher, APublisherThatIsAheadOfItselfIsFoundOut) {
  put_value(5, 17, 10);
  EXPECT_EQ(read(), Found::wrong);
  put_value(5, 18, 10);
  EXPECT_EQ(read(), Found::wrong);
}

TEST_F(LyingPublisher, AValueLargerThanItsSlotIsFoundOut) {
  for (const std::uint64_t size :
       {std::uint64_t{4097}, std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
    put_value(5, 10, size);
    EXPECT_EQ(read(), Found::wrong) << size;
  }
}

TEST_F(LyingPublisher, NumbersThatFallAreFoundOut) {
  const auto reader = open();
  SlotValue value;
  put_value(5, 10, 10);
  ASSERT_EQ(reader->read(value), Found::value);
  put_value(4, 8, 10);
  EXPECT_EQ(reader->read(value), Found::wrong);
}

TEST_F(LyingPublisher, TimesAreCutToWhatCanBe) {
  for (const std::int64_t time : {std::numeric_limits<std::int64_t>::min(), std::int64_t{-1},
                                  std::numeric_limits<std::int64_t>::max()}) {
    put_value(5, 10, 10);
    put<std::int64_t>(heads_at + 64 + 16, time);
    SlotValue value;
    ASSERT_EQ(open()->read(value), Found::value);
    EXPECT_GE(value.published, Time());
    EXPECT_LE(value.published, Clock::now());
  }
}

// Everything changes all the time. Each read ends, and none reads beyond the memory.
TEST_F(LyingPublisher, AMemoryThatIsWrittenOverHarmsNobody) {
  std::atomic<bool> is_over{false};
  std::thread writer([&] {
    std::mt19937_64 random(49);
    while (!is_over) {
      const std::size_t at = newest_at + random() % 0x200 / 8 * 8;
      put<std::uint64_t>(at, random() >> (random() % 64));
      const std::uint64_t number = 1 + random() % 100;
      put_value(number, 2 * number - random() % 2, random() % 5000);
    }
  });
  std::array<int, 3> count{};
  for (int i = 0; i < 20'000; ++i) {
    const auto reader = open();
    SlotValue value;
    for (int j = 0; j < 3; ++j) {
      const Found found = reader->read(value);
      ++count[static_cast<std::size_t>(found)];
      if (found == Found::value) {
        ASSERT_LE(value.bytes.size(), 4096U);
      }
    }
    (void)reader->is_over();
  }
  is_over = true;
  writer.join();
  EXPECT_EQ(count[0] + count[1] + count[2], 60'000);
  EXPECT_NE(count[static_cast<std::size_t>(Found::value)], 0);
  EXPECT_NE(count[static_cast<std::size_t>(Found::wrong)], 0);
}

}  // namespace
}  // namespace rr::channel
