// SPDX-License-Identifier: Apache-2.0
// What a bad line does to a board: frames that are damaged, cut, joined or made up.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "runtime/arduino/test/wired_board.hpp"

namespace rr {
namespace {

using serial::Kind;
using testing::bytes_of;
using ::testing::ElementsAre;
using testing::Frame;
using ::testing::IsEmpty;
using testing::stuffed;
using testing::WiredBoard;

const Frame call{Kind::Call, 1, bytes_of({0, 1, 20, 22})};
const Frame answer{Kind::Reply, 1, bytes_of({1, 42})};

TEST(BadLines, NoSingleDamagedBitIsTaken) {
  const std::vector<uint8_t> good = stuffed(call);
  for (std::size_t at = 0; at < 8 * good.size(); ++at) {
    WiredBoard board;
    board.hello();
    std::vector<uint8_t> bad = good;
    bad[at / 8] = static_cast<uint8_t>(bad[at / 8] ^ (1 << at % 8));
    // The zeros in front are not needed by a frame that follows a good one.
    const auto answers = board.say(bad);
    EXPECT_TRUE(answers.empty() || at / 8 == 0) << at;
    EXPECT_THAT(board.say(call), ElementsAre(answer)) << "the next frame is understood, " << at;
    EXPECT_EQ(board.calls, 1);
  }
}

TEST(BadLines, NoSingleLostOrDoubledByteIsTaken) {
  const std::vector<uint8_t> good = stuffed(call);
  for (std::size_t at = 1; at + 1 < good.size(); ++at) {
    WiredBoard board;
    board.hello();
    std::vector<uint8_t> lost = good;
    lost.erase(lost.begin() + static_cast<std::ptrdiff_t>(at));
    EXPECT_THAT(board.say(lost), IsEmpty());
    std::vector<uint8_t> doubled = good;
    doubled.insert(doubled.begin() + static_cast<std::ptrdiff_t>(at), good[at]);
    EXPECT_THAT(board.say(doubled), IsEmpty());
    EXPECT_THAT(board.say(call), ElementsAre(answer));
  }
}

TEST(BadLines, AHalfFrameCostsNothingBehindIt) {
  const std::vector<uint8_t> good = stuffed(call);
  for (std::size_t size = 0; size < good.size(); ++size) {
    WiredBoard board;
    board.hello();
    std::vector<uint8_t> bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size));
    bytes.insert(bytes.end(), good.begin(), good.end());
    EXPECT_THAT(board.say(bytes), ElementsAre(answer)) << size;
  }
}

TEST(BadLines, AFrameThatIsTooLongIsDropped) {
  WiredBoard board;
  board.hello();
  EXPECT_THAT(board.say({Kind::Call, 1, std::vector<uint8_t>(200, 1)}), IsEmpty());
  EXPECT_THAT(board.say(call), ElementsAre(answer));
}

TEST(BadLines, NoiseIsNotTaken) {
  WiredBoard board;
  board.hello();
  std::mt19937 random(3);
  std::vector<uint8_t> noise(1'000'000);
  for (uint8_t& byte : noise) {
    // Often zero, so that many short frames come about.
    byte = static_cast<uint8_t>(random() % 4 == 0 ? 0 : random());
  }
  EXPECT_THAT(board.say(noise), IsEmpty());
  EXPECT_EQ(board.calls, 0);
  EXPECT_THAT(board.say(call), ElementsAre(answer));
}

}  // namespace
}  // namespace rr
