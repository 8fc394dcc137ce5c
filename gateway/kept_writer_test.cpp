// SPDX-License-Identifier: Apache-2.0
#include "gateway/kept_writer.hpp"

#include <gtest/gtest.h>

#include "gateway/properties.hpp"

namespace rr::gateway {
namespace {

using std::chrono::seconds;

NatsMessage waiting_message(const std::string& text) {
  NatsMessage result{"rrkept.h.r.$life"};
  result.payload = bytes_of(text);
  return result;
}
NatsMessage stored_answer(const std::string& text) {
  NatsMessage result{"in.1"};
  result.payload = bytes_of(text);
  return result;
}

class KeptWriterTest : public ::testing::Test {
 protected:
  KeptWriter writer{"in"};
  KeptWriter::Clock::time_point now{seconds(1'000)};
};

TEST_F(KeptWriterTest, RepeatsWhatIsNotConfirmed) {
  EXPECT_EQ(writer.add(waiting_message("up"), now).reply, "in.1");
  EXPECT_TRUE(writer.late(now + seconds(1)).empty());
  const auto late = writer.late(now + seconds(2));
  ASSERT_EQ(late.size(), 1U);
  EXPECT_EQ(text_of(late[0].payload), "up");
  EXPECT_EQ(late[0].reply, "in.1");
  EXPECT_TRUE(writer.late(now + seconds(3)).empty());
  EXPECT_EQ(writer.late(now + seconds(4)).size(), 1U);
  EXPECT_FALSE(writer.take("1", stored_answer(R"({"stream":"RRKEPT","seq":4})")).wants_stream);
  EXPECT_TRUE(writer.is_empty());
  EXPECT_TRUE(writer.late(now + seconds(60)).empty());
}

TEST_F(KeptWriterTest, RepeatsTheNewestOnly) {
  writer.add(waiting_message("up"), now);
  EXPECT_EQ(writer.add(waiting_message("down"), now).reply, "in.2");
  // The confirmation of the older one says nothing of the newer.
  writer.take("1", stored_answer(R"({"seq":1})"));
  const auto late = writer.late(now + seconds(2));
  ASSERT_EQ(late.size(), 1U);
  EXPECT_EQ(text_of(late[0].payload), "down");
  writer.take("2", stored_answer(R"({"seq":2})"));
  EXPECT_TRUE(writer.is_empty());
}

TEST_F(KeptWriterTest, AsksForTheStream) {
  writer.add(waiting_message("up"), now);
  NatsMessage nobody = stored_answer("");
  nobody.is_unanswered = true;
  EXPECT_TRUE(writer.take("1", nobody).wants_stream);
  EXPECT_EQ(writer.late(now + seconds(2)).size(), 1U);
}

TEST_F(KeptWriterTest, ReportsWhatTheStreamDoesNotTake) {
  writer.add(waiting_message("up"), now);
  const auto outcome =
      writer.take("1", stored_answer(R"({"error":{"err_code":10077,"description":"no room"}})"));
  ASSERT_TRUE(outcome.refusal.has_value());
  EXPECT_EQ(outcome.refusal->text(), "the broker has refused a message to `rr/h/r/$life`: no room");
  EXPECT_FALSE(writer.is_empty());
  EXPECT_FALSE(writer.take("7", stored_answer("{}")).refusal.has_value());
  EXPECT_FALSE(writer.take("1", stored_answer("nonsense")).refusal.has_value());
  EXPECT_FALSE(writer.is_empty());
}

TEST_F(KeptWriterTest, ForgetsWhatIsNotPermitted) {
  writer.add(waiting_message("up"), now);
  writer.drop("rrkept.other");
  EXPECT_FALSE(writer.is_empty());
  writer.drop("rrkept.h.r.$life");
  EXPECT_TRUE(writer.is_empty());
}

}  // namespace
}  // namespace rr::gateway
