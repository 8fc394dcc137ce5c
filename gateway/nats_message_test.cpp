// SPDX-License-Identifier: Apache-2.0
#include "gateway/nats_message.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gateway/properties.hpp"

namespace rr::gateway {
namespace {

using std::chrono::seconds;

TEST(NatsMessages, KeepAllValuesOfProperties) {
  EXPECT_EQ(header_text("double[] a"), "double[] a");
  EXPECT_EQ(header_text("50 %"), "50 %25");
  EXPECT_EQ(header_text(" a\r\n"), "%20a%0D%0A");
  EXPECT_EQ(header_text(""), "%");
  EXPECT_EQ(header_text(" "), "%20");
  std::string all;
  for (int i = 0; i < 256; ++i) all += static_cast<char>(i);
  for (const std::string& value : {all, std::string(), std::string("%"), std::string("%%41"),
                                   std::string("  "), std::string("\xC3\xA4")}) {
    const std::string text = header_text(value);
    EXPECT_EQ(value_of_header(text), value);
    for (const char c : text) EXPECT_TRUE(c >= ' ' && c <= '~');
    EXPECT_FALSE(text.starts_with(' ') || text.ends_with(' '));
  }
}

TEST(NatsMessages, ReadWhatOthersWrite) {
  EXPECT_EQ(value_of_header("100%"), "100%");
  EXPECT_EQ(value_of_header("%zz%4"), "%zz%4");
  EXPECT_EQ(value_of_header("%c3%a4"), "\xC3\xA4");
}

TEST(NatsMessages, AreCarriedThereAndBack) {
  Message message{"rr/h/r/s/$call/eve/open", bytes_of(std::string("\0\1\xff", 3))};
  message.properties = {{"type", "int32"}, {"reason", "a\nb"}};
  message.response_topic = "rr/$reply/eve/1";
  message.correlation = bytes_of(std::string("\0id", 3));
  message.expiry = seconds(5);
  const NatsMessage sent = nats_message_of(message);
  EXPECT_EQ(sent.subject, "rr.h.r.s.$call.eve.open");
  EXPECT_EQ(sent.reply, "rr.$reply.eve.1");
  EXPECT_EQ(header_of(sent, "reason"), "a%0Ab");
  EXPECT_EQ(header_of(sent, "rr-correlation"), "006964");
  EXPECT_EQ(expiry_of(sent), seconds(5));
  const auto got = message_of(sent);
  ASSERT_TRUE(got.has_value());
  EXPECT_EQ(got->topic, message.topic);
  EXPECT_EQ(got->payload, message.payload);
  EXPECT_EQ(got->properties, message.properties);
  EXPECT_EQ(got->response_topic, message.response_topic);
  EXPECT_EQ(got->correlation, message.correlation);
  EXPECT_FALSE(got->retained);
}

TEST(NatsMessages, OfOthersAreNotTrusted) {
  NatsMessage message{"rr.a"};
  message.reply = "rr..b";
  message.headers = {{"rr-correlation", "0"},
                     {"Nats-Sequence", "4"},
                     {"rr-expiry", "-1"},
                     {"type", "x"},
                     {"type", "y"}};
  const auto got = message_of(message);
  ASSERT_TRUE(got.has_value());
  EXPECT_TRUE(got->correlation.empty());
  EXPECT_TRUE(got->response_topic.empty());
  EXPECT_EQ(got->properties, (Properties{{"type", "x"}, {"type", "y"}}));
  EXPECT_EQ(expiry_of(message), std::nullopt);
  EXPECT_EQ(message_of(NatsMessage{"a..b"}), std::nullopt);
}

TEST(NatsMessages, HaveTheSizeThatTheBrokerLimits) {
  NatsMessage message{"a"};
  message.payload = Bytes(10);
  EXPECT_EQ(size_of(message), 10U);
  // NATS/1.0, type: x, and an empty line.
  message.headers = {{"type", "x"}};
  EXPECT_EQ(size_of(message), 10U + std::string("NATS/1.0\r\ntype: x\r\n\r\n").size());
}

}  // namespace
}  // namespace rr::gateway
