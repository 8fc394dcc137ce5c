// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string_view>

#include "runtime/cpp/src/channel/strand.hpp"
#include "runtime/cpp/src/channel/strand_turn.hpp"

namespace rr::channel {
namespace {

using std::chrono_literals::operator""h;
using std::chrono_literals::operator""us;

Frame waiting(std::string_view text) {
  return {{reinterpret_cast<const std::byte*>(text.data()), text.size()}, {}, {}};
}
std::string_view text_in(const Frame& frame) {
  return {reinterpret_cast<const char*>(frame.bytes.data()), frame.bytes.size()};
}

class StrandTurnTest : public ::testing::Test {
 protected:
  StrandTurnTest() { scratch_->waiting.clear(); }
  ~StrandTurnTest() override { scratch_->waiting.clear(); }

  const std::shared_ptr<Account> account_;
  Strand strand_{100, account_};
  ScratchLease scratch_;
};

TEST_F(StrandTurnTest, IsThatOfItsThreadAndStrand) {
  EXPECT_EQ(StrandTurn::current(strand_), nullptr);
  StrandTurn turn(strand_, *scratch_, longest_turn);
  EXPECT_EQ(StrandTurn::current(strand_), &turn);
  EXPECT_EQ(&turn.scratch(), &*scratch_);
  Strand other(100, account_);
  {
    const StrandTurn inner(other, *scratch_, longest_turn);
    EXPECT_EQ(StrandTurn::current(other), &inner);
    EXPECT_EQ(StrandTurn::current(strand_), nullptr) << "not the innermost";
  }
  EXPECT_EQ(StrandTurn::current(strand_), &turn);
}

TEST_F(StrandTurnTest, HandsOutWhatWaits) {
  for (const char* text : {"a", "b", "c"}) scratch_->waiting.push_back(waiting(text));
  StrandTurn turn(strand_, *scratch_, longest_turn);
  ASSERT_TRUE(turn.has_next());
  EXPECT_EQ(text_in(turn.next()), "a");
  EXPECT_EQ(text_in(turn.take_last()), "c");
  EXPECT_EQ(text_in(turn.next()), "b");
  EXPECT_FALSE(turn.has_next());
}

TEST_F(StrandTurnTest, ItsRestIsQueuedFirst) {
  strand_.push(waiting("later"));
  for (const char* text : {"a", "b", "c"}) scratch_->waiting.push_back(waiting(text));
  StrandTurn turn(strand_, *scratch_, longest_turn);
  turn.next();
  strand_.push_rest(turn);
  EXPECT_FALSE(turn.has_next());
  for (const char* text : {"b", "c", "later"}) EXPECT_EQ(text_in(strand_.pop()), text);
  EXPECT_FALSE(strand_.has_lost());
}

TEST_F(StrandTurnTest, KeepsWhatIsSaidOfIt) {
  StrandTurn turn(strand_, *scratch_, longest_turn);
  EXPECT_TRUE(turn.is_held());
  turn.set_held(false);
  EXPECT_FALSE(turn.is_held());
  EXPECT_FALSE(turn.is_put_off());
  turn.set_put_off(true);
  EXPECT_TRUE(turn.is_put_off());
}

TEST_F(StrandTurnTest, IsOverAfterItsTime) {
  StrandTurn without(strand_, *scratch_, 0us);
  EXPECT_TRUE(without.is_over());
  StrandTurn with(strand_, *scratch_, 1h);
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(with.is_over());
}

TEST_F(StrandTurnTest, GoesOnWhenNobodyWaits) {
  StrandTurn turn(strand_, *scratch_, 1h);
  EXPECT_FALSE(turn.has_gone_on());
  static_cast<void>(turn.is_over());
  turn.go_on();
  EXPECT_FALSE(turn.is_over());
  EXPECT_TRUE(turn.has_gone_on());
  EXPECT_FALSE(turn.has_gone_on()) << "asked before";
}

TEST_F(StrandTurnTest, IsSlowWhenAFewRequestsTakeATick) {
  StrandTurn turn(strand_, *scratch_, longest_turn);
  const Time begin = coarse_now();
  while (coarse_now() <= begin) {
  }
  turn.count(15);
  EXPECT_TRUE(turn.is_slow());
  turn.count(1);
  EXPECT_FALSE(turn.is_slow()) << "many";
}

// The bytes of a frame without an owner are those of a buffer that is used again.
TEST_F(StrandTurnTest, AFrameIsKeptWithBytesOfItsOwn) {
  std::string bytes = "text";
  const Frame kept = Strand::keep(waiting(bytes));
  bytes = "over";
  EXPECT_EQ(text_in(kept), "text");
}

}  // namespace
}  // namespace rr::channel
