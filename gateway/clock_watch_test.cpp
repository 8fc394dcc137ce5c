// SPDX-License-Identifier: Apache-2.0
// The system's clock is set while a gateway runs: nothing is thrown away for that.
#include "gateway/clock_watch.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "gateway/call_window.hpp"
#include "gateway/stream_log.hpp"
#include "gateway/testing/folder.hpp"

namespace rr::gateway {
namespace {

using testing::Folder;

constexpr std::int64_t second = 1'000'000'000;
constexpr std::int64_t day = 86'400 * second;
constexpr std::int64_t today = 1'795'779'856 * second;

std::vector<std::uint64_t> numbers_in(StreamLog& log) {
  std::vector<std::uint64_t> all;
  for (std::uint64_t next = 1;;) {
    const auto record = log.read_from(next);
    if (!record) return all;
    all.push_back(record->number);
    next = record->number + 1;
  }
}

TEST(GatewayClock, AJumpIsNoticedOnce) {
  const auto begin = ClockWatch::Clock::now();
  ClockWatch watch(begin, today);
  EXPECT_EQ(watch.take_jump(begin + std::chrono::seconds(5), today + 5 * second), 0);
  EXPECT_EQ(watch.take_jump(begin + std::chrono::seconds(6), today + 6 * second + day), day);
  EXPECT_EQ(watch.take_jump(begin + std::chrono::seconds(7), today + 7 * second + day), 0);
  EXPECT_EQ(watch.take_jump(begin + std::chrono::seconds(8), today + 8 * second), -day);
}

TEST(GatewayClock, AClockThatIsSteeredDoesNotJump) {
  const auto begin = ClockWatch::Clock::now();
  ClockWatch watch(begin, today);
  for (int i = 1; i <= 100; ++i) {
    EXPECT_EQ(watch.take_jump(begin + std::chrono::seconds(i), today + i * (second + second / 10)),
              0);
  }
}

// A computer without a battery begins in 1970 until it finds the network.
TEST(GatewayClock, RecordsOfAClockThatIsSetLaterStay) {
  const Folder folder;
  {
    StreamLog log(folder.path(), {.age = std::chrono::seconds(60), .file_bytes = 100});
    for (int i = 1; i <= 4; ++i) log.append(1, "", std::vector<std::byte>(40), i * second);
    log.clock_was_set(today);
    log.discard_old(today + 30 * second);
    EXPECT_EQ(numbers_in(log), (std::vector<std::uint64_t>{1, 2, 3, 4}));
    // Their age counts from then on.
    log.discard_old(today + 120 * second);
    EXPECT_TRUE(numbers_in(log).empty());
    log.append(1, "", std::vector<std::byte>(40), 5 * second);
  }
  // Another process does not know when that was.
  StreamLog log(folder.path(), {.age = std::chrono::seconds(60)});
  log.discard_old(today);
  EXPECT_EQ(numbers_in(log), (std::vector<std::uint64_t>{5}));
}

TEST(GatewayClock, RecordsStayAfterAJumpAndBack) {
  const Folder folder;
  StreamLog log(folder.path(), {.age = std::chrono::seconds(60), .file_bytes = 100});
  log.append(1, "", std::vector<std::byte>(40), today);
  log.clock_was_set(30 * day);
  log.append(1, "", std::vector<std::byte>(40), today + 30 * day);
  log.discard_old(today + 30 * day);
  log.clock_was_set(-30 * day);
  log.append(1, "", std::vector<std::byte>(40), today + second);
  log.discard_old(today + second);
  EXPECT_EQ(numbers_in(log), (std::vector<std::uint64_t>{1, 2, 3}));
}

TEST(GatewayClock, ACallIsNotExecutedAgainAfterAJump) {
  const Folder folder;
  {
    CallWindow window(folder.path(), {}, today);
    window.begin("one", today);
    window.end("one", {}, today);
    window.clock_was_set(day);
    window.forget_old(today + day + second);
    EXPECT_EQ(window.state("one"), CallWindow::State::answered);
  }
  // Or when the clock was set while the gateway was not there.
  CallWindow window(folder.path(), {}, today + 50 * day);
  EXPECT_EQ(window.state("one"), CallWindow::State::answered);
  window.forget_old(today + 50 * day + 11 * 60 * second);
  EXPECT_EQ(window.state("one"), CallWindow::State::unknown);
}

}  // namespace
}  // namespace rr::gateway
