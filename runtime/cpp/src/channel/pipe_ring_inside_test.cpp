// SPDX-License-Identifier: Apache-2.0
// The service and readers of one ring in one process, and services that do not keep to the rules.
#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "runtime/cpp/src/channel/pipe_ring.hpp"
#include "runtime/cpp/src/channel/shared_header.hpp"

namespace rr::channel {
namespace {

using Found = PipeRingReader::Found;
using Steps = PipeRingSteps<Synchronization>;

constexpr std::size_t smallest = PipeRingSize::smallest;

TEST(PipeRingSize, IsAPowerOfTwoWithRoomForSomePackets) {
  EXPECT_EQ(PipeRingSize::for_packet(0).ring, smallest);
  EXPECT_EQ(PipeRingSize::for_packet(smallest / 8 - 8).ring, smallest);
  EXPECT_EQ(PipeRingSize::for_packet(smallest / 8).ring, 2 * smallest);
  EXPECT_EQ(PipeRingSize::for_packet(PipeRingSize::largest / 4 - 8).ring, PipeRingSize::largest);
  EXPECT_EQ(PipeRingSize::for_packet(PipeRingSize::largest / 4).ring, 0U);
  EXPECT_EQ(PipeRingSize::for_packet(~std::size_t{0}).ring, 0U);
}

TEST(PipeRingSize, AHeaderMayNotSayAnything) {
  EXPECT_TRUE(PipeRingSize{smallest}.is_right());
  EXPECT_TRUE(PipeRingSize{PipeRingSize::largest}.is_right());
  for (const std::size_t ring :
       {std::size_t{0}, smallest / 2, smallest + 8, 3 * smallest, 2 * PipeRingSize::largest}) {
    EXPECT_FALSE(PipeRingSize{ring}.is_right()) << ring;
  }
}

TEST(PipeRingSize, APacketTakesAQuarterAtMost) {
  const PipeRingSize size{smallest};
  EXPECT_TRUE(size.fits(smallest / 4 - 8));
  EXPECT_FALSE(size.fits(smallest / 4 - 7));
  EXPECT_FALSE(size.fits(~std::size_t{0}));
}

class PipeRing : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!platform::has_shared_memory()) GTEST_SKIP() << "this system has no shared memory";
    std::error_code error;
    writer_ = PipeRingWriter::make({smallest}, 42, error);
    ASSERT_NE(writer_, nullptr) << error.message();
    memory_ = platform::map_published_memory(writer_->handle(), size().memory(), error);
  }
  struct Reader {
    std::shared_ptr<SlotHolds::Words> words = std::make_shared<SlotHolds::Words>();
    std::unique_ptr<PipeRingReader> ring{};
    std::uint64_t turn = 0;
    std::uint32_t number = 0;

    [[nodiscard]] std::uint64_t cursor() const { return Steps::cursor(*words, turn); }
    [[nodiscard]] std::uint64_t asked() const { return Steps::asked(*words, turn); }
  };
  Reader open() {
    Reader reader;
    std::error_code error;
    reader.ring = PipeRingReader::open(writer_->handle(), error);
    EXPECT_NE(reader.ring, nullptr) << error.message();
    reader.turn = ++turns_;
    reader.number = writer_->admit().value();
    EXPECT_TRUE(reader.ring->begin(
        std::make_shared<PipeCursor>(reader.words),
        {.position = writer_->position(), .turn = reader.turn, .reader = reader.number}));
    return reader;
  }
  static std::string read(Reader& reader) {
    RingPacket packet;
    switch (reader.ring->read(packet)) {
      case Found::packet:
        return {reinterpret_cast<const char*>(packet.bytes.data()), packet.bytes.size()};
      case Found::nothing:
        return "nothing";
      case Found::late:
        return "late";
      default:
        return "wrong";
    }
  }
  void put(std::string_view text) { writer_->put(std::as_bytes(std::span(text))); }
  [[nodiscard]] PipeRingSize size() const { return writer_->size(); }

  std::unique_ptr<PipeRingWriter> writer_;
  platform::SharedMemory memory_;
  std::uint64_t turns_ = 0;
};

TEST_F(PipeRing, PacketsAreReadInTheirOrderByEachReader) {
  Reader one = open();
  put("first");
  Reader two = open();
  put("second");
  put("");
  EXPECT_EQ(read(one), "first");
  EXPECT_EQ(read(one), "second");
  EXPECT_EQ(read(two), "second");
  EXPECT_EQ(read(two), "");
  EXPECT_EQ(read(two), "nothing");
  EXPECT_EQ(read(one), "");
  EXPECT_EQ(read(one), "nothing");
  EXPECT_EQ(writer_->count(), 3U);
}

TEST_F(PipeRing, AReaderSaysHowFarItIs) {
  Reader reader = open();
  put("packet");
  EXPECT_EQ(reader.cursor(), 0U);
  EXPECT_EQ(read(reader), "packet");
  EXPECT_EQ(read(reader), "nothing");
  EXPECT_EQ(reader.cursor(), writer_->position());
  // And without having read all, after a part of the ring.
  const std::string large(smallest / 8, 'x');
  for (int i = 0; i < 4; ++i) put(large);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(read(reader), large);
  EXPECT_GT(reader.cursor(), writer_->position() - 3 * large.size());
}

TEST_F(PipeRing, WordsOfAnotherReaderSayNothing) {
  Reader reader = open();
  put("packet");
  EXPECT_EQ(read(reader), "packet");
  EXPECT_EQ(read(reader), "nothing");
  EXPECT_TRUE(reader.ring->ask());
  EXPECT_EQ(Steps::cursor(*reader.words, reader.turn + 1), 0U);
  EXPECT_EQ(Steps::asked(*reader.words, reader.turn + 1), 0U);
  Steps::begin(*reader.words, reader.turn + 1, 8);
  EXPECT_EQ(Steps::cursor(*reader.words, reader.turn + 1), 8U);
  EXPECT_EQ(Steps::asked(*reader.words, reader.turn + 1), 0U);
}

TEST_F(PipeRing, AReaderAsksToBeToldWhenThereIsNothing) {
  Reader reader = open();
  EXPECT_TRUE(reader.ring->ask());
  EXPECT_EQ(reader.asked(), 1U);
  put("packet");
  EXPECT_FALSE(reader.ring->ask()) << "there is one";
  EXPECT_EQ(read(reader), "packet");
  EXPECT_TRUE(reader.ring->ask());
  EXPECT_EQ(reader.asked(), 3U);
}

TEST_F(PipeRing, ACursorThatIsDetachedWritesNothing) {
  const auto words = std::make_shared<SlotHolds::Words>();
  PipeCursor cursor(words);
  cursor.begin(1, 8);
  cursor.detach();
  cursor.advance(16);
  EXPECT_EQ(Steps::cursor(*words, 1), 8U);
  cursor.begin(2, 24);
  EXPECT_EQ(Steps::cursor(*words, 2), 0U);
  Steps::Words ring;
  const Steps::Until until{0};
  EXPECT_TRUE(cursor.ask(ring, until, 0));
  EXPECT_EQ(Steps::asked(*words, 1), 0U);
}

TEST_F(PipeRing, GoesRoundAndRound) {
  Reader reader = open();
  for (int i = 0; i < 20'000; ++i) {
    const std::string text(static_cast<std::size_t>(i) % 61, static_cast<char>('a' + i % 26));
    if (const auto position = writer_->must_give_up(text.size())) {
      ASSERT_LE(position, reader.cursor());
      writer_->give_up(reader.cursor());
    }
    put(text);
    ASSERT_EQ(read(reader), text);
    ASSERT_EQ(read(reader), "nothing");
  }
}

TEST_F(PipeRing, HasRoomForWhatIsNotGivenUp) {
  const std::string quarter(smallest / 4 - sizeof(PipeRecord), 'q');
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(writer_->must_give_up(quarter.size()), 0U);
    put(quarter);
  }
  EXPECT_EQ(writer_->must_give_up(0), sizeof(PipeRecord));
  EXPECT_EQ(writer_->must_give_up(quarter.size()), smallest / 4);
  writer_->give_up(smallest / 4);
  EXPECT_EQ(writer_->must_give_up(quarter.size()), 0U);
}

TEST_F(PipeRing, AReaderThatIsTooSlowFindsOut) {
  Reader reader = open();
  const std::string quarter(smallest / 4 - sizeof(PipeRecord), 'q');
  for (int i = 0; i < 4; ++i) put(quarter);
  EXPECT_EQ(read(reader), quarter);
  writer_->give_up(smallest / 2);
  EXPECT_EQ(read(reader), "late");
  put(quarter);
  put(quarter);
  EXPECT_EQ(read(reader), "late");
  put(quarter);
  EXPECT_EQ(read(reader), "late") << "the ring is not long enough for what it has missed";
}

// It may get the others by messages, with packets between that are not in the ring.
TEST_F(PipeRing, AReaderThatIsDismissedReadsWhatWasForItAndNoMore) {
  Reader one = open();
  Reader two = open();
  put("first");
  put("second");
  EXPECT_EQ(read(one), "first");
  EXPECT_FALSE(one.ring->is_at_end());
  writer_->dismiss(one.number);
  put("third");
  EXPECT_FALSE(one.ring->is_at_end()) << "it has not read all";
  EXPECT_EQ(read(one), "second");
  EXPECT_EQ(read(one), "nothing");
  EXPECT_TRUE(one.ring->is_at_end());
  EXPECT_TRUE(one.ring->ask()) << "there is nothing for it";
  for (const char* text : {"first", "second", "third"}) EXPECT_EQ(read(two), text);
  EXPECT_FALSE(two.ring->is_at_end());
}

TEST_F(PipeRing, AdmitsSoManyReaders) {
  for (std::uint32_t number = 0; number < pipe_ring_readers; ++number) {
    ASSERT_EQ(writer_->admit(), number);
  }
  EXPECT_EQ(writer_->admit(), std::nullopt);
}

TEST_F(PipeRing, WhatAReaderHasMissedCanBeCopied) {
  put("first");
  const std::uint64_t position = writer_->position();
  put("second");
  put("third");
  std::vector<std::string> missed;
  const auto add = [&](const Allocation& packet, std::size_t size) {
    missed.emplace_back(reinterpret_cast<const char*>(packet.bytes), size);
  };
  EXPECT_TRUE(writer_->for_each_from(position, add));
  EXPECT_EQ(missed, (std::vector<std::string>{"second", "third"}));
  EXPECT_TRUE(writer_->for_each_from(writer_->position(), add));
  EXPECT_EQ(missed.size(), 2U);
  EXPECT_FALSE(writer_->for_each_from(writer_->position() + 8, add));
  EXPECT_FALSE(writer_->for_each_from(4, add));
  EXPECT_TRUE(writer_->has(position));
  writer_->give_up(position);
  EXPECT_FALSE(writer_->has(0));
  EXPECT_FALSE(writer_->for_each_from(0, add));
  EXPECT_EQ(missed.size(), 2U);
}

// Both at once: what is copied is whole, or known to be late.
TEST_F(PipeRing, IsWrittenWhileItIsRead) {
  constexpr int count = 200'000;
  std::atomic<int> read_all{0};
  std::vector<std::thread> threads;
  std::vector<Reader> readers;
  for (int i = 0; i < 2; ++i) readers.push_back(open());
  for (Reader& reader : readers) {
    threads.emplace_back([&] {
      for (int next = 0; next < count;) {
        const std::string text = read(reader);
        if (text == "nothing") {
          std::this_thread::yield();
          continue;
        }
        if (text != std::to_string(next)) return;
        ++next;
      }
      ++read_all;
    });
  }
  for (int i = 0; i < count; ++i) {
    const std::string text = std::to_string(i);
    while (const std::uint64_t position = writer_->must_give_up(text.size())) {
      const std::uint64_t slowest = std::min(readers[0].cursor(), readers[1].cursor());
      if (slowest >= position) {
        writer_->give_up(slowest);
      } else {
        std::this_thread::yield();
      }
    }
    put(text);
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(read_all, 2);
}

TEST_F(PipeRing, OthersCannotBeOpened) {
  std::error_code error;
  platform::Descriptor handle;
  const auto with_header = [&](std::size_t memory_size, std::size_t ring, SharedKind kind) {
    auto memory = platform::make_published_memory(memory_size, handle, error);
    const SharedHeader header = SharedHeader::of(kind, ring);
    std::memcpy(memory.bytes(), &header, sizeof header);
    return PipeRingReader::open(handle, error);
  };
  const std::size_t right = PipeRingSize{smallest}.memory();
  EXPECT_NE(with_header(right, smallest, SharedKind::packets), nullptr);
  EXPECT_EQ(with_header(right, smallest, SharedKind::slots), nullptr);
  EXPECT_EQ(error, std::errc::invalid_argument);
  EXPECT_EQ(with_header(right, smallest * 2, SharedKind::packets), nullptr);
  EXPECT_EQ(with_header(right + 4096, smallest, SharedKind::packets), nullptr);
  EXPECT_EQ(with_header(right, smallest - 8, SharedKind::packets), nullptr);
  EXPECT_EQ(PipeRingReader::open(platform::Descriptor(), error), nullptr);
}

TEST_F(PipeRing, AReaderBeginsWhereARecordMayBe) {
  std::error_code error;
  const auto ring = PipeRingReader::open(writer_->handle(), error);
  const auto cursor = std::make_shared<PipeCursor>(std::make_shared<SlotHolds::Words>());
  EXPECT_FALSE(ring->begin(cursor, {.position = 4}));
  EXPECT_FALSE(ring->begin(cursor, {.position = 8, .reader = pipe_ring_readers}));
  EXPECT_TRUE(ring->begin(cursor, {.position = 8}));
}

// A service that may write anything.
class LyingService : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!platform::has_shared_memory()) GTEST_SKIP() << "this system has no shared memory";
    std::error_code error;
    platform::Descriptor handle;
    memory_ = platform::make_published_memory(PipeRingSize{smallest}.memory(), handle, error);
    const SharedHeader header = SharedHeader::of(SharedKind::packets, smallest);
    std::memcpy(memory_.bytes(), &header, sizeof header);
    words_ = new (memory_.bytes() + 0x100) Steps::Words;
    until_ = new (memory_.bytes() + 0x1000) Steps::Until;
    Steps::admit(*until_);
    reader_ = PipeRingReader::open(handle, error);
    ASSERT_NE(reader_, nullptr) << error.message();
    ASSERT_TRUE(reader_->begin(std::make_shared<PipeCursor>(std::make_shared<SlotHolds::Words>()),
                               {.position = 64}));
  }
  void write(std::uint32_t size) const {
    const PipeRecord record{size};
    std::memcpy(memory_.bytes() + 0x3000 + 64, &record, sizeof record);
  }
  Found read(std::uint64_t written) {
    words_->written = written;
    RingPacket packet;
    return reader_->read(packet);
  }

  platform::SharedMemory memory_;
  Steps::Words* words_ = nullptr;
  Steps::Until* until_ = nullptr;
  std::unique_ptr<PipeRingReader> reader_;
};

TEST_F(LyingService, APositionThatCannotBeIsWrong) {
  EXPECT_EQ(read(64), Found::nothing);
  EXPECT_EQ(read(56), Found::wrong);
  EXPECT_EQ(read(0), Found::wrong);
  EXPECT_EQ(read(64 + 4), Found::wrong);
  EXPECT_EQ(read(64 + smallest + 8), Found::wrong);
  EXPECT_EQ(read(~std::uint64_t{0}), Found::wrong);
}

TEST_F(LyingService, AnEndThatCannotBeIsWrong) {
  for (const std::uint64_t end : {0U, 56U, 64U + 4U}) {
    Steps::dismiss(*until_, end);
    EXPECT_EQ(read(64 + 16), Found::wrong) << end;
  }
}

TEST_F(LyingService, ASizeThatCannotBeIsWrong) {
  for (const std::uint32_t size : {9U, 1000U, 0xFFFF'FFFFU}) {
    write(size);
    EXPECT_EQ(read(64 + 16), Found::wrong) << size;
  }
  write(8);
  EXPECT_EQ(read(64 + 16), Found::packet);
}

TEST_F(LyingService, APacketThatIsGivenUpIsLate) {
  write(0xFFFF'FFFFU);
  words_->kept_from = 72;
  EXPECT_EQ(read(64 + 16), Found::late);
  EXPECT_EQ(read(64 + 2 * smallest), Found::late);
  words_->kept_from = 64;
  EXPECT_EQ(read(64 + 16), Found::wrong);
}

}  // namespace
}  // namespace rr::channel
