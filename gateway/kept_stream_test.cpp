// SPDX-License-Identifier: Apache-2.0
#include "gateway/kept_stream.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gateway/properties.hpp"

namespace rr::gateway {
namespace {

using ::testing::HasSubstr;

TEST(KeptStream, IsMadeForTheNewestOfEachSubject) {
  EXPECT_EQ(stream_create_subject(), "$JS.API.STREAM.CREATE.RRKEPT");
  const std::string text = stream_create_text(3);
  EXPECT_THAT(text, HasSubstr(R"("max_msgs_per_subject":1)"));
  EXPECT_THAT(text, HasSubstr(R"("num_replicas":3)"));
  EXPECT_THAT(text, HasSubstr(R"("republish":{"dest":"rr.>","src":"rrkept.>"})"));
}

TEST(KeptStream, IsReadBySubject) {
  EXPECT_EQ(reader_create_subject("a1", "rrkept.h.*.$life"),
            "$JS.API.CONSUMER.CREATE.RRKEPT.a1.rrkept.h.*.$life");
  const std::string text = reader_create_text("a1", "rrkept.h.*.$life", "_INBOX.x");
  EXPECT_THAT(text, HasSubstr(R"("filter_subject":"rrkept.h.*.$life")"));
  EXPECT_THAT(text, HasSubstr(R"("deliver_subject":"_INBOX.x")"));
}

TEST(KeptStream, SaysWhatItWillDeliver) {
  const auto answer = read_answer(
      bytes_of(R"({"type":"t","name":"a1","created":"2026-11-27T11:44:16.25Z","num_pending":7})"));
  ASSERT_TRUE(answer.has_value());
  EXPECT_EQ(answer->code, 0);
  EXPECT_EQ(answer->pending, 7U);
  EXPECT_EQ(answer->created.count(), 1'795'779'856'250'000'000);
}

TEST(KeptStream, SaysWhatIsWrong) {
  const auto answer = read_answer(
      bytes_of(R"({"error":{"code":404,"err_code":10059,"description":"stream not found"}})"));
  ASSERT_TRUE(answer.has_value());
  EXPECT_EQ(answer->code, stream_not_found);
  EXPECT_EQ(answer->description, "stream not found");
  EXPECT_EQ(read_answer(bytes_of(R"({"error":{}})"))->code, -1);
  for (const char* text : {"", "7", "[]", "{", "\xff"}) {
    EXPECT_FALSE(read_answer(bytes_of(text)).has_value()) << text;
  }
  EXPECT_EQ(read_answer(bytes_of(R"({"num_pending":-1,"created":4})"))->pending, 0U);
}

TEST(KeptStream, NumbersItsMessages) {
  const auto place = kept_place("$JS.ACK.RRKEPT.a1.1.42.7.1795780256250000000.0");
  ASSERT_TRUE(place.has_value());
  EXPECT_EQ(place->number, 42U);
  EXPECT_EQ(place->stored.count(), 1'795'780'256'250'000'000);
  for (const char* reply :
       {"", "rr.a", "$JS.ACK.RRKEPT.a1.1.42.7.1795780256250000000", "$JS.ACK.OTHER.a1.1.42.7.1.0",
        "$JS.ACK.RRKEPT.a1.1.x.7.1.0", "$JS.ACK.RRKEPT.a1.1.42.7.1.0.9"}) {
    EXPECT_FALSE(kept_place(reply).has_value()) << reply;
  }
}

}  // namespace
}  // namespace rr::gateway
