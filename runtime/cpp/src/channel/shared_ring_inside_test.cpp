// SPDX-License-Identifier: Apache-2.0
// One ring, without another process.
#include <gtest/gtest.h>

#include <array>
#include <deque>
#include <limits>
#include <random>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "runtime/cpp/src/channel/shared_ring.hpp"

namespace rr::channel {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using Steps = RingReader::Steps;

constexpr std::size_t ring_size = 4096;

class SharedRingTest : public ::testing::Test {
 protected:
  std::ptrdiff_t write(std::string_view text) {
    const platform::Buffer piece{reinterpret_cast<const std::byte*>(text.data()), text.size()};
    return writer_.write({&piece, 1}, 0, [&](std::uint32_t how) { woken_.push_back(how); });
  }
  std::string read(std::size_t most = 2 * ring_size) {
    std::vector<std::byte> room(most);
    room_wakes_ = 0;
    const std::ptrdiff_t size = reader_.read(room, room_wakes_);
    if (size == platform::nothing_now) return "nothing";
    if (size == platform::broken) return "broken";
    return {reinterpret_cast<const char*>(room.data()), static_cast<std::size_t>(size)};
  }

  SharedRing::Words words_;
  std::vector<std::byte> bytes_ = std::vector<std::byte>(ring_size);
  const SharedRing ring_{&words_, bytes_.data(), ring_size};
  RingWriter writer_{ring_};
  RingReader reader_{ring_};
  std::vector<std::uint32_t> woken_;
  std::uint32_t room_wakes_ = 0;
};

TEST(RingSteps, SleepOnlyOnAWordThatIsAsItWasSeen) {
  Synchronization::SleepWord word{1};
  Synchronization::sleep_on_shared(word, 0, 60s);  // it is another: returns at once
  Synchronization::sleep_on_shared(word, 1, 1ms);  // nothing wakes it: returns for its time
  EXPECT_EQ(word.load(), 1U);
}

TEST(RingSteps, SayWhoIsToBeWoken) {
  using Ring = RingSteps<Synchronization>;
  SharedRing::Words words;
  std::atomic<bool> is_interrupted{true};
  EXPECT_EQ(Ring::publish(words, 1), Ring::runs);
  EXPECT_TRUE(Ring::watch(words, 0));
  EXPECT_FALSE(Ring::watch(words, 1));
  EXPECT_EQ(Ring::publish(words, 2), Ring::watches);
  EXPECT_FALSE(Ring::interrupt(words));
  Ring::sleep(words, 2, is_interrupted, 20s);
  EXPECT_EQ(words.reader.load(), Ring::runs);
  words.reader = Ring::sleeps;
  EXPECT_TRUE(Ring::interrupt(words));
  EXPECT_EQ(Ring::release(words, 1), 0U);
  EXPECT_FALSE(Ring::want_room(words, Ring::by_bell, 3, 2));
  EXPECT_TRUE(Ring::want_room(words, Ring::by_word, 2, 2));
  EXPECT_EQ(Ring::release(words, 2), std::uint32_t{Ring::by_bell | Ring::by_word});
  EXPECT_EQ(words.room.load(), 0U);
}

TEST_F(SharedRingTest, GivesWhatWasWritten) {
  EXPECT_EQ(read(), "nothing");
  EXPECT_EQ(write("one"), 3);
  EXPECT_EQ(write("two"), 3);
  EXPECT_TRUE(reader_.is_ready());
  EXPECT_EQ(read(4), "onet");
  EXPECT_EQ(read(), "wo");
  EXPECT_FALSE(reader_.is_ready());
  EXPECT_EQ(read(), "nothing");
  EXPECT_EQ(write(""), 0);
  EXPECT_EQ(read(), "nothing");
  EXPECT_TRUE(woken_.empty());
}

TEST_F(SharedRingTest, TakesWhatThereIsRoomFor) {
  const std::string much(ring_size + 10, 'x');
  EXPECT_EQ(write(much), static_cast<std::ptrdiff_t>(ring_size));
  EXPECT_EQ(write("more"), 0);
  EXPECT_EQ(read(3), "xxx");
  EXPECT_EQ(write("more"), 3);
  EXPECT_EQ(read(), std::string(ring_size - 3, 'x') + "mor");
}

TEST_F(SharedRingTest, TakesPiecesBehindThoseThatAreSkipped) {
  const std::array<std::string_view, 4> texts = {"ab", "", "cdef", "gh"};
  std::vector<platform::Buffer> pieces;
  for (const std::string_view text : texts) {
    pieces.push_back({reinterpret_cast<const std::byte*>(text.data()), text.size()});
  }
  for (std::size_t skipped = 0; skipped <= 8; ++skipped) {
    EXPECT_EQ(writer_.write(pieces, skipped, [](std::uint32_t) {}),
              static_cast<std::ptrdiff_t>(8 - skipped));
    const std::string expected = std::string("abcdefgh").substr(skipped);
    EXPECT_EQ(read(), expected.empty() ? "nothing" : expected);
  }
}

TEST_F(SharedRingTest, IsAQueueForAllSizes) {
  std::mt19937 random(46);
  std::deque<char> model;
  char next = 0;
  std::size_t turns = 0;
  while (turns < 300 * ring_size) {
    std::string text(random() % (random() % 8 == 0 ? 2 * ring_size : 100), ' ');
    for (std::size_t i = 0; i < text.size(); ++i) {
      text[i] = static_cast<char>(static_cast<std::size_t>(next) + i);
    }
    const std::ptrdiff_t written = write(text);
    ASSERT_EQ(written,
              static_cast<std::ptrdiff_t>(std::min(text.size(), ring_size - model.size())));
    model.insert(model.end(), text.begin(), text.begin() + written);
    next = static_cast<char>(next + written);
    turns += static_cast<std::size_t>(written);
    const std::size_t most = random() % (random() % 8 == 0 ? 2 * ring_size : 100);
    const std::size_t size = std::min(most, model.size());
    ASSERT_EQ(read(most),
              size == 0
                  ? "nothing"
                  : std::string(model.begin(), model.begin() + static_cast<std::ptrdiff_t>(size)));
    model.erase(model.begin(), model.begin() + static_cast<std::ptrdiff_t>(size));
  }
}

TEST_F(SharedRingTest, WakesWhoeverHasAskedForIt) {
  EXPECT_FALSE(reader_.watch());
  write("one");
  write("two");
  EXPECT_EQ(woken_, std::vector<std::uint32_t>{Steps::watches});
  EXPECT_TRUE(reader_.watch());  // there is something already
  write("three");
  EXPECT_EQ(woken_.size(), 1U);
  words_.reader = Steps::sleeps;
  write("four");
  EXPECT_EQ(woken_.back(), Steps::sleeps);
  EXPECT_EQ(words_.reader.load(), Steps::runs);
}

TEST_F(SharedRingTest, SaysWhereTheWriterRan) {
  EXPECT_EQ(reader_.ring().words, &words_);
  EXPECT_EQ(writer_.ring().bytes, bytes_.data());
  words_.processor = 1'000'000;
  EXPECT_TRUE(reader_.is_written_elsewhere());
  write("here");
  EXPECT_LT(words_.processor.load(), 1'000'000U);
}

TEST_F(SharedRingTest, AReaderThatWatchesIsNotInterrupted) {
  EXPECT_FALSE(reader_.watch());
  writer_.interrupt_reader();
  EXPECT_EQ(words_.reader.load(), Steps::watches);
  reader_.run();
  EXPECT_EQ(words_.reader.load(), Steps::runs);
  words_.reader = Steps::sleeps;
  writer_.interrupt_reader();
  EXPECT_EQ(words_.reader.load(), Steps::runs);
}

TEST_F(SharedRingTest, TellsOfRoomOnce) {
  write(std::string(ring_size, 'x'));
  EXPECT_FALSE(writer_.want_room());
  read(1);
  EXPECT_EQ(room_wakes_, Steps::by_bell);
  read(1);
  EXPECT_EQ(room_wakes_, 0U);
  EXPECT_TRUE(writer_.want_room());
}

TEST_F(SharedRingTest, WaitsForRoom) {
  write(std::string(ring_size, 'x'));
  std::thread waiting([&] {
    while (words_.taken.load() == 0) writer_.wait_for_room(20s);
  });
  while ((words_.room.load() & Steps::by_word) == 0) std::this_thread::yield();
  read(1);
  EXPECT_EQ(room_wakes_, Steps::by_word);
  platform::wake_shared(&words_.room);
  waiting.join();
}

TEST_F(SharedRingTest, ASleepingReaderIsInterrupted) {
  std::atomic<bool> is_interrupted{false};
  std::thread sleeping([&] {
    while (!is_interrupted) reader_.sleep(is_interrupted, 20s);
  });
  while (words_.reader.load() != Steps::sleeps) std::this_thread::yield();
  is_interrupted = true;
  reader_.interrupt();
  sleeping.join();
  EXPECT_EQ(words_.reader.load(), Steps::runs);
  reader_.sleep(is_interrupted, 20s);  // not again, before that is forgotten
  is_interrupted = false;
  reader_.sleep(is_interrupted, 1ms);
  EXPECT_EQ(words_.reader.load(), Steps::runs);
}

// The index of the other side may be anything.
TEST_F(SharedRingTest, BelievesNoIndex) {
  for (const std::uint64_t wrong :
       {std::uint64_t{ring_size + 1}, std::uint64_t{1} << 32, std::uint64_t{1} << 63,
        std::numeric_limits<std::uint64_t>::max()}) {
    words_.written = wrong;
    EXPECT_EQ(read(), "broken") << wrong;
    words_.taken = wrong;
    EXPECT_EQ(write(std::string(ring_size, 'x')), platform::broken) << wrong;
  }
}

// Its own indices are in private memory.
TEST_F(SharedRingTest, KeepsItsOwnIndices) {
  std::mt19937_64 random(47);
  for (int i = 0; i < 100'000; ++i) {
    words_.written = random() >> (random() % 64);
    words_.taken = random() >> (random() % 64);
    words_.reader = static_cast<std::uint32_t>(random());
    words_.room = static_cast<std::uint32_t>(random());
    words_.processor = static_cast<std::uint32_t>(random());
    const std::string text(random() % ring_size, 'x');
    EXPECT_LE(write(text), static_cast<std::ptrdiff_t>(text.size()));
    EXPECT_LE(read().size(), ring_size);
  }
}

// The reader is in another thread; bytes come in the order in which they were written.
TEST_F(SharedRingTest, CarriesBytesBetweenThreads) {
  constexpr std::size_t count = 2'000'000;
  std::thread writing([&] {
    std::size_t written = 0;
    std::string text;
    while (written != count) {
      text.resize(std::min<std::size_t>(1 + written % 1000, count - written));
      for (std::size_t i = 0; i < text.size(); ++i) text[i] = static_cast<char>((written + i) * 7);
      const platform::Buffer piece{reinterpret_cast<const std::byte*>(text.data()), text.size()};
      const std::ptrdiff_t size = writer_.write({&piece, 1}, 0, [&](std::uint32_t how) {
        if (how == Steps::sleeps) platform::wake_shared(&words_.reader);
      });
      written += static_cast<std::size_t>(size);
      if (size == 0) writer_.wait_for_room(20s);
    }
  });
  std::atomic<bool> is_interrupted{false};
  std::vector<std::byte> room(700);
  std::size_t read = 0;
  std::size_t wrong = 0;
  while (read != count) {
    std::uint32_t wake = 0;
    const std::ptrdiff_t size = reader_.read(room, wake);
    if (wake != 0) platform::wake_shared(&words_.room);
    if (size == platform::nothing_now) {
      reader_.sleep(is_interrupted, 20s);
      continue;
    }
    for (std::ptrdiff_t i = 0; i < size; ++i, ++read) {
      if (room[static_cast<std::size_t>(i)] != static_cast<std::byte>(read * 7)) ++wrong;
    }
  }
  writing.join();
  EXPECT_EQ(wrong, 0U);
}

}  // namespace
}  // namespace rr::channel
