// SPDX-License-Identifier: Apache-2.0
#include "rr/realtime/signals.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <thread>

namespace rr::realtime {
namespace {

/// All words are the same number in a snapshot that is whole.
struct Words {
  std::array<std::uint64_t, 24> words{};

  [[nodiscard]] bool is_whole() const {
    return std::ranges::all_of(words, [&](std::uint64_t word) { return word == words[0]; });
  }
  static Words of(std::uint64_t number) {
    Words value;
    value.words.fill(number);
    return value;
  }
};

/// ROBDEF_SNAPSHOTS of the environment; ./check --long asks for ten million.
std::uint64_t snapshot_count() {
  const char* const wanted = std::getenv("ROBDEF_SNAPSHOTS");
  return wanted == nullptr ? 50'000 : std::strtoull(wanted, nullptr, 10);
}

TEST(RealtimeSignals, ASnapshotIsNeverTorn) {
  SignalGroup<Words> group;
  std::atomic<bool> is_over{false};
  std::thread writer([&] {
    for (std::uint64_t i = 1; !is_over.load(std::memory_order_relaxed); ++i) {
      group.write(Words::of(i));
    }
  });
  std::uint64_t newest = 0;
  std::uint64_t torn = 0;
  std::uint64_t older = 0;
  for (std::uint64_t i = 0; i < snapshot_count(); ++i) {
    const Words words = group.read();
    torn += words.is_whole() ? 0 : 1;
    older += words.words[0] < newest ? 1 : 0;
    newest = words.words[0];
  }
  is_over = true;
  writer.join();
  EXPECT_EQ(torn, 0U);
  EXPECT_EQ(older, 0U);
}

TEST(RealtimeSignals, AReaderThatMeetsTheWriterEachTimeGetsNothing) {
  SignalGroup<Words> group(Words::of(7));
  EXPECT_FALSE(group.try_read(0));
  EXPECT_EQ(group.try_read(1)->words[0], 7U);
  EXPECT_EQ(group.version(), 1U);
}

TEST(RealtimeSignals, AMailboxGivesTheNewestWhole) {
  Mailbox<Words> mailbox(Words::of(5));
  EXPECT_FALSE(mailbox.take());
  EXPECT_EQ(mailbox.value().words[0], 5U);

  constexpr std::uint64_t last = 300'000;
  std::thread writer([&] {
    for (std::uint64_t i = 6; i <= last; ++i) mailbox.put(Words::of(i));
  });
  std::uint64_t newest = 5;
  std::uint64_t wrong = 0;
  while (newest != last) {
    if (!mailbox.take()) continue;
    const Words& words = mailbox.value();
    wrong += words.is_whole() && words.words[0] > newest ? 0 : 1;
    newest = words.words[0];
  }
  writer.join();
  EXPECT_EQ(wrong, 0U);
  EXPECT_FALSE(mailbox.take());
}

}  // namespace
}  // namespace rr::realtime
