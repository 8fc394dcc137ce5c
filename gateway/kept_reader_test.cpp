// SPDX-License-Identifier: Apache-2.0
#include "gateway/kept_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gateway/properties.hpp"

namespace rr::gateway {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

NatsMessage reader_answer(const std::string& text) {
  NatsMessage result{"in"};
  result.payload = bytes_of(text);
  return result;
}
NatsMessage promised(int pending) {
  return reader_answer(R"({"created":"2026-11-27T11:44:16Z","num_pending":)" +
                       std::to_string(pending) + "}");
}
/// A message that the stream has stored `age` before 11:44:16.
NatsMessage kept_message(const std::string& text, int number, seconds age) {
  NatsMessage result = reader_answer(text);
  result.reply = "$JS.ACK.RRKEPT.n-1-1.1." + std::to_string(number) + ".1." +
                 std::to_string((1'795'779'856 - age.count()) * 1'000'000'000) + ".0";
  return result;
}

class KeptReaderTest : public ::testing::Test {
 protected:
  KeptReader reader{"answers", "messages", "n"};
  KeptReader::Clock::time_point now{seconds(1'000)};
};

TEST_F(KeptReaderTest, AsksAndReads) {
  EXPECT_TRUE(reader.is_done(now));
  EXPECT_EQ(reader.add("rrkept.h.*.$life"), 1U);
  EXPECT_EQ(reader.inbox_of(1), "messages.1");
  const auto requests = reader.requests(now);
  ASSERT_EQ(requests.size(), 1U);
  EXPECT_EQ(requests[0].subject, "$JS.API.CONSUMER.CREATE.RRKEPT.n-1-1.rrkept.h.*.$life");
  EXPECT_EQ(requests[0].reply, "answers.1-1");
  EXPECT_TRUE(reader.requests(now).empty());
  EXPECT_FALSE(reader.is_done(now));
  // Messages may overtake the answer.
  reader.take_message("1", kept_message("up", 41, seconds(8)), now);
  EXPECT_FALSE(reader.is_done(now));
  reader.take_answer("1-1", promised(2), now);
  EXPECT_FALSE(reader.is_done(now));
  reader.take_message("1", kept_message("down", 42, seconds(0)), now);
  EXPECT_TRUE(reader.is_done(now));
  // Newer ones arrive as others do.
  reader.take_message("1", kept_message("late", 43, seconds(0)), now);
  const auto all = reader.take();
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(text_of(all[0].message.payload), "up");
  EXPECT_EQ(all[0].number, 41U);
  EXPECT_EQ(all[0].age, seconds(8));
  EXPECT_EQ(all[1].age, seconds(0));
  EXPECT_TRUE(reader.is_done(now));
}

TEST_F(KeptReaderTest, NothingIsRetainedWithoutAStream) {
  reader.add("rrkept.>");
  static_cast<void>(reader.requests(now));
  reader.take_answer("1-1", reader_answer(R"({"error":{"err_code":10059}})"), now);
  EXPECT_TRUE(reader.is_done(now));
  EXPECT_TRUE(reader.take().empty());
}

TEST_F(KeptReaderTest, AsksAgain) {
  reader.add("rrkept.>");
  EXPECT_EQ(reader.requests(now).size(), 1U);
  NatsMessage nobody = reader_answer("");
  nobody.is_unanswered = true;
  reader.take_answer("1-1", nobody, now);
  EXPECT_EQ(reader.trouble(), "nobody answers, perhaps it is not enabled");
  EXPECT_TRUE(reader.requests(now).empty());
  now += milliseconds(500);
  EXPECT_EQ(reader.requests(now).size(), 1U);
  // The answer to the first request comes late.
  reader.take_answer("1-1", promised(0), now);
  EXPECT_FALSE(reader.is_done(now));
  reader.take_answer(
      "1-2", reader_answer(R"({"error":{"err_code":10008,"description":"no leader"}})"), now);
  EXPECT_EQ(reader.trouble(), "no leader");
  EXPECT_FALSE(reader.is_done(now + seconds(60)));
  now += milliseconds(500);
  EXPECT_EQ(reader.requests(now).size(), 1U);
  now += seconds(5);
  EXPECT_EQ(reader.requests(now).size(), 1U);
}

TEST_F(KeptReaderTest, DoesNotWaitForWhatWasReplaced) {
  reader.add("rrkept.>");
  static_cast<void>(reader.requests(now));
  reader.take_answer("1-1", promised(2), now);
  reader.take_message("1", kept_message("up", 1, seconds(0)), now);
  EXPECT_FALSE(reader.is_done(now + seconds(1)));
  EXPECT_TRUE(reader.is_done(now + seconds(2)));
  EXPECT_EQ(reader.take().size(), 1U);
}

TEST_F(KeptReaderTest, WhatIsNotPermittedIsNotRead) {
  reader.add("rrkept.a");
  reader.add("rrkept.b");
  EXPECT_EQ(reader.requests(now).size(), 2U);
  EXPECT_FALSE(reader.refuse("rr.a"));
  EXPECT_TRUE(reader.refuse("$JS.API.CONSUMER.CREATE.RRKEPT.n-1-1.rrkept.a"));
  EXPECT_FALSE(reader.is_done(now));
  reader.take_answer("2-1", promised(0), now);
  EXPECT_TRUE(reader.is_done(now));
}

TEST_F(KeptReaderTest, IgnoresWhatItDoesNotKnow) {
  reader.add("rrkept.a");
  static_cast<void>(reader.requests(now));
  reader.take_answer("2-1", promised(0), now);
  reader.take_answer("x", promised(0), now);
  reader.take_message("1", reader_answer("without a place"), now);
  reader.take_answer("1-1", reader_answer("nonsense"), now);
  EXPECT_FALSE(reader.is_done(now));
  reader.take_answer("1-1", promised(0), now);
  EXPECT_TRUE(reader.is_done(now));
  EXPECT_TRUE(reader.take().empty());
}

}  // namespace
}  // namespace rr::gateway
