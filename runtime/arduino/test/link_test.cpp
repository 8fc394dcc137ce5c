// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

TEST(Crc, IsTheOneOfTheProtocol) {
  uint16_t crc = serial::crcStart;
  for (const char byte : std::string("123456789")) {
    crc = serial::crcOf(crc, static_cast<uint8_t>(byte));
  }
  EXPECT_EQ(crc, 0x29B1);
}

TEST(Sessions, HelloTellsWhatTheBoardServes) {
  WiredBoard board;
  EXPECT_THAT(
      board.say({Kind::Hello, 0, bytes_of({'R', 'D', 1, 7, 0, 50, 0})}),
      ElementsAre(Frame{Kind::Reply, 0, bytes_of({1, 7, 0, 59, 59, 2, 1, 2, 3, 4, 5, 6, 7, 8})}));
  EXPECT_TRUE(board.link.isConnected());
}

TEST(Sessions, AnotherVersionIsAnsweredAndNotServed) {
  WiredBoard board;
  const auto frames = board.say({Kind::Hello, 0, bytes_of({'R', 'D', 2, 7, 0, 50, 0})});
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].body[0], 1);
  EXPECT_FALSE(board.link.isConnected());
}

TEST(Sessions, WithoutOneNothingIsDone) {
  WiredBoard board;
  EXPECT_THAT(board.say({Kind::Get, 9, bytes_of({0, 0})}),
              ElementsAre(Frame{Kind::NoSession, 9, {}}));
  EXPECT_EQ(board.calls, 0);
}

TEST(Sessions, AResetIsToldAndForgetsTheSession) {
  WiredBoard board;
  board.hello();
  board.reset();
  EXPECT_THAT(board.listen(), ElementsAre(Frame{Kind::Started, 0, {}}));
  EXPECT_THAT(board.say({Kind::Get, 1, bytes_of({0, 0})}),
              ElementsAre(Frame{Kind::NoSession, 1, {}}));
}

TEST(Sessions, ALateHelloDoesNotBeginAnew) {
  WiredBoard board;
  board.hello();
  (void)board.say({Kind::Get, 1, bytes_of({0, 0})});
  EXPECT_THAT(board.say({Kind::Hello, 0, bytes_of({'R', 'D', 1, 7, 0, 50, 0})}), IsEmpty());
  EXPECT_EQ(board.say({Kind::Get, 2, bytes_of({0, 0})}).size(), 1U);
}

TEST(Requests, AreAnswered) {
  WiredBoard board;
  board.hello();
  EXPECT_THAT(board.say({Kind::Set, 1, bytes_of({0, 0, 0, 0, 0, 0, 0, 0, 0xF0, 0x3F})}),
              ElementsAre(Frame{Kind::Reply, 1, bytes_of({0})}));
  EXPECT_EQ(board.property, 1.0);
  EXPECT_THAT(board.say({Kind::Get, 2, bytes_of({0, 0})}),
              ElementsAre(Frame{Kind::Reply, 2, bytes_of({0, 0, 0, 0, 0, 0, 0, 0xF0, 0x3F})}));
  EXPECT_THAT(board.say({Kind::Call, 3, bytes_of({0, 1, 20, 22})}),
              ElementsAre(Frame{Kind::Reply, 3, bytes_of({1, 42})}));
}

TEST(Requests, ArrivingAgainAreAnsweredAgainAndDoneOnce) {
  WiredBoard board;
  board.hello();
  const Frame call{Kind::Call, 1, bytes_of({0, 1, 1, 2})};
  const Frame answer{Kind::Reply, 1, bytes_of({1, 3})};
  EXPECT_THAT(board.say(call), ElementsAre(answer));
  EXPECT_THAT(board.say(call), ElementsAre(answer));
  EXPECT_EQ(board.calls, 1);
}

TEST(Requests, OutOfOrderAreDropped) {
  WiredBoard board;
  board.hello();
  EXPECT_THAT(board.say({Kind::Get, 2, bytes_of({0, 0})}), IsEmpty());
  EXPECT_THAT(board.say({Kind::Get, 255, bytes_of({0, 0})}), IsEmpty());
  EXPECT_EQ(board.calls, 0);
}

TEST(Requests, TheSequenceNumbersGoRound) {
  WiredBoard board;
  board.hello();
  for (int count = 1; count < 600; ++count) {
    const Frame get{Kind::Get, static_cast<uint8_t>(count), bytes_of({0, 0})};
    ASSERT_EQ(board.say(get).size(), 1U) << count;
  }
  EXPECT_EQ(board.calls, 599);
}

TEST(Requests, FailWithACode) {
  WiredBoard board;
  board.hello();
  EXPECT_THAT(board.say({Kind::Call, 1, bytes_of({0, 0})}),
              ElementsAre(Frame{Kind::Error, 1, bytes_of({0, 9, 0})}));
  EXPECT_THAT(board.say({Kind::Get, 2, bytes_of({5, 0})}),
              ElementsAre(Frame{Kind::Error, 2, bytes_of({0, 4, 0})}));
  EXPECT_THAT(board.say({Kind::Call, 3, bytes_of({0, 1, 1})}),
              ElementsAre(Frame{Kind::Error, 3, bytes_of({1, 11, 0})}));
  EXPECT_THAT(board.say({Kind::Call, 4, bytes_of({0, 1, 1, 2, 3})}),
              ElementsAre(Frame{Kind::Error, 4, bytes_of({1, 11, 0})}));
  EXPECT_THAT(board.say({Kind::Get, 5, {}}),
              ElementsAre(Frame{Kind::Error, 5, bytes_of({0, 13, 0})}));
}

TEST(Requests, SayWhyTheyAreRefused) {
  WiredBoard board;
  board.hello();
  EXPECT_THAT(board.say({Kind::Call, 1, bytes_of({0, 1, 200, 100})}),
              ElementsAre(Frame{Kind::Error, 1, bytes_of({1, 29, 1})}));
  std::string text;
  uint8_t sequence = 1;
  for (;;) {
    const auto size = static_cast<int>(text.size());
    const auto frames =
        board.say({Kind::Text, ++sequence, bytes_of({serial::reasonText, size & 0xFF, size >> 8})});
    ASSERT_EQ(frames.size(), 1U);
    ASSERT_EQ(frames[0].kind, Kind::Reply);
    if (frames[0].body.size() == 3) break;
    text.append(frames[0].body.begin() + 3, frames[0].body.end());
  }
  EXPECT_EQ(text, "the sum is more than 255, which is the most that a uint8 holds");
  ++sequence;
  EXPECT_THAT(board.say({Kind::Call, sequence, bytes_of({0, 1, 1})}),
              ElementsAre(Frame{Kind::Error, sequence, bytes_of({1, 11, 0})}))
      << "a reason is for one refusal";
  ++sequence;
  EXPECT_THAT(board.say({Kind::Text, sequence, bytes_of({serial::reasonText, 0, 0})}),
              ElementsAre(Frame{Kind::Error, sequence, bytes_of({0, 29, 0})}));
}

TEST(Requests, OfADoubleTakeTheSameBytesForEachValue) {
  WiredBoard board;
  board.hello();
  uint8_t sequence = 0;
  for (const double value : {0.0, 1.0, -1.0 / 3, 1e300, 0x1.0001000100010p0}) {
    board.property = value;
    const auto request = stuffed({Kind::Get, ++sequence, bytes_of({0, 0})});
    ASSERT_EQ(board.say(request).size(), 1U);
    EXPECT_EQ(request.size() + board.line.from_board.size(), 27U);
  }
}

TEST(Streams, ThatFollowAnotherFindNothingThatWasBegunThere) {
  WiredBoard board;
  board.hello();
  const std::vector<uint8_t> call = stuffed({Kind::Call, 1, bytes_of({0, 1, 1, 2})});
  (void)board.say(std::vector<uint8_t>(call.begin(), call.end() - 1));
  ASSERT_TRUE(board.link.start(Kind::Event, 0, 2));
  ASSERT_TRUE(board.link.finish());
  testing::Line next;
  board.link.begin(next);
  EXPECT_FALSE(board.link.isConnected());
  next.to_board = {0};
  for (int count = 0; count < 40; ++count) board.link.poll();
  EXPECT_EQ(board.calls, 0);
  EXPECT_THAT(testing::frames_in(next.from_board), ElementsAre(Frame{Kind::Started, 0, {}}));
}

TEST(Texts, ComeInPieces) {
  WiredBoard board;
  board.hello();
  std::string text;
  uint8_t sequence = 0;
  for (;;) {
    const auto size = static_cast<int>(text.size());
    const auto frames = board.say({Kind::Text, ++sequence, bytes_of({1, size & 0xFF, size >> 8})});
    ASSERT_EQ(frames.size(), 1U);
    ASSERT_GE(frames[0].body.size(), 3U);
    if (frames[0].body.size() == 3) break;
    text.append(frames[0].body.begin() + 3, frames[0].body.end());
  }
  EXPECT_EQ(text.substr(0, 18), "service example.b\n");
  EXPECT_EQ(text.substr(text.size() - 4), "end\n");
  EXPECT_GT(sequence, 2);
  ++sequence;
  EXPECT_THAT(board.say({Kind::Text, sequence, bytes_of({2, 0, 0})}),
              ElementsAre(Frame{Kind::Error, sequence, bytes_of({0, 29, 0})}));
  ++sequence;
  EXPECT_THAT(board.say({Kind::Text, sequence, bytes_of({0, 0xFF, 0xFF})}),
              ElementsAre(Frame{Kind::Error, sequence, bytes_of({0, 29, 0})}));
}

TEST(Events, AreSentUntilTheyAreAcknowledged) {
  WiredBoard board;
  EXPECT_FALSE(board.link.start(Kind::Event, 0, 2)) << "nobody listens";
  board.hello();
  for (const uint8_t value : bytes_of({1, 2})) {
    ASSERT_TRUE(board.link.start(Kind::Event, 0, 2));
    write(board.link.values(), value);
    ASSERT_TRUE(board.link.finish());
  }
  const auto first = board.listen();
  ASSERT_EQ(first.size(), 1U);
  EXPECT_EQ(first[0].body, bytes_of({0, 2, 1}));
  EXPECT_THAT(board.listen(), IsEmpty());
  testing::now += 50;
  EXPECT_EQ(board.listen(), first);
  const auto second = board.say({Kind::Ack, first[0].sequence, {}});
  ASSERT_EQ(second.size(), 1U);
  EXPECT_EQ(second[0].sequence, static_cast<uint8_t>(first[0].sequence + 1));
  EXPECT_EQ(second[0].body, bytes_of({0, 2, 2}));
  testing::now += 50;
  EXPECT_EQ(board.say({Kind::Ack, first[0].sequence, {}}), second) << "an old Ack means nothing";
  EXPECT_THAT(board.say({Kind::Ack, second[0].sequence, {}}), IsEmpty());
}

TEST(Events, OfWhichThereAreTooManyAreRefused) {
  WiredBoard board;
  board.hello();
  int taken = 0;
  while (board.link.start(Kind::Event, 0, 2) && write(board.link.values(), uint64_t{1}) &&
         board.link.finish()) {
    ++taken;
  }
  EXPECT_EQ(taken, 3);  // of 12 bytes each in 40
}

TEST(Wires, SendTheNewestValueWhileTheyAreOpen) {
  WiredBoard board;
  board.hello();
  board.wire = 5;
  board.link.markChanged(0);
  EXPECT_THAT(board.listen(), IsEmpty());
  board.wire = 6;
  EXPECT_THAT(board.say({Kind::Open, 1, bytes_of({0, 3})}),
              ElementsAre(Frame{Kind::Reply, 1, bytes_of({3})},
                          Frame{Kind::WireValue, 0, bytes_of({0, 3, 6, 0})}));
  board.wire = 7;
  board.link.markChanged(0);
  board.wire = 8;
  board.link.markChanged(0);
  EXPECT_THAT(board.listen(), ElementsAre(Frame{Kind::WireValue, 0, bytes_of({0, 3, 8, 0})}));
  (void)board.say({Kind::Close, 2, bytes_of({0, 3})});
  board.link.markChanged(0);
  EXPECT_THAT(board.listen(), IsEmpty());
}

TEST(Wires, AreClosedByANewSession) {
  WiredBoard board;
  board.hello(7);
  (void)board.say({Kind::Open, 1, bytes_of({0, 3})});
  EXPECT_TRUE(board.link.isOpen(0));
  board.hello(8);
  EXPECT_FALSE(board.link.isOpen(0));
}

TEST(Streams, ThatDoNotSayWhatTheyTakeAreFedInSmallPieces) {
  WiredBoard board;
  board.line.room = 0;
  board.reset();
  board.line.from_board.clear();
  board.link.poll();
  EXPECT_LE(board.line.from_board.size(), 8U);
  board.hello();
  EXPECT_EQ(board.say({Kind::Get, 1, bytes_of({0, 0})}).size(), 1U);
}

TEST(Streams, ThatAreFullAreNotWrittenTo) {
  WiredBoard board;
  board.hello();
  board.line.room = 0;
  EXPECT_THAT(board.say({Kind::Get, 1, bytes_of({0, 0})}), IsEmpty());
  EXPECT_TRUE(board.line.from_board.empty());
  board.line.room = 3;
  EXPECT_EQ(board.listen().size(), 1U);
}

}  // namespace
}  // namespace rr
