// SPDX-License-Identifier: Apache-2.0
#include "gateway/exported_wires.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "gateway/elements.hpp"

namespace rr::gateway {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::ElementsAre;

/// Takes as many messages as it has room for.
class NarrowCarrier final : public Carrier {
 public:
  void start(CarrierHandler&, Message) override {}
  void stop(const Message&) override {}
  Published publish(const Message& message) override {
    if (room == 0) return Published::later;
    --room;
    messages.push_back(message);
    return Published::taken;
  }
  void subscribe(const std::string&) override {}
  [[nodiscard]] std::string url() const override { return "narrow"; }
  /// Topics that it has got since.
  std::vector<std::string> take_topics() {
    std::vector<std::string> topics;
    for (const Message& message : messages) topics.push_back(message.topic);
    messages.clear();
    return topics;
  }

  std::size_t room = 100;
  std::vector<Message> messages;
};

class GatewayExportedWires : public ::testing::Test {
 protected:
  using Wire = std::shared_ptr<ExportedWires::Wire>;

  static ExportedWires::Options options(const std::string& topic) {
    return {topic, dynamic::ValueType::parse("double")};
  }
  static bool put(const Wire& wire, double value) { return ExportedWires::put(*wire, value, {}); }
  [[nodiscard]] Bytes payload(double value) const {
    return encode_element(dynamic::ValueType::parse("double"), value);
  }

  NarrowCarrier carrier;
  ExportedWires wires;
  ExportedWires::Clock::time_point now = ExportedWires::Clock::now();
  Wire a = wires.add(options("a"));
  Wire b = wires.add(options("b"));
  Wire c = wires.add(options("c"));
};

TEST_F(GatewayExportedWires, OnlyTheNewestValueIsPublished) {
  carrier.room = 0;
  EXPECT_TRUE(put(a, 1));
  EXPECT_FALSE(put(a, 2));
  EXPECT_FALSE(wires.pump(carrier, now));
  EXPECT_TRUE(put(a, 3));
  EXPECT_FALSE(wires.pump(carrier, now));
  carrier.room = 5;
  EXPECT_TRUE(wires.pump(carrier, now));
  ASSERT_EQ(carrier.messages.size(), 1U);
  EXPECT_EQ(carrier.messages[0].payload, payload(3));
  EXPECT_TRUE(carrier.messages[0].retained);
}

TEST_F(GatewayExportedWires, TakeTurnsWhenThereIsLittleRoom) {
  std::vector<std::string> topics;
  for (int round = 0; round < 4; ++round) {
    for (const Wire& wire : {a, b, c}) put(wire, round);
    carrier.room = 2;
    EXPECT_FALSE(wires.pump(carrier, now));
    for (const std::string& topic : carrier.take_topics()) topics.push_back(topic);
  }
  EXPECT_THAT(topics, ElementsAre("a", "b", "c", "a", "b", "c", "a", "b"));
}

TEST_F(GatewayExportedWires, ArePublishedAgainWithTheSameNumber) {
  put(a, 1);
  put(b, 2);
  EXPECT_TRUE(wires.pump(carrier, now));
  const auto first = carrier.messages;
  carrier.messages.clear();
  wires.publish_again();
  EXPECT_TRUE(wires.pump(carrier, now));
  ASSERT_EQ(carrier.messages.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(carrier.messages[i].topic, first[i].topic);
    EXPECT_EQ(carrier.messages[i].payload, first[i].payload);
    EXPECT_EQ(carrier.messages[i].properties, first[i].properties);
  }
  carrier.messages.clear();
  put(a, 3);
  EXPECT_TRUE(wires.pump(carrier, now));
  ASSERT_EQ(carrier.messages.size(), 1U);
  EXPECT_EQ(carrier.messages[0].find("stream"), first[0].find("stream"));
  EXPECT_EQ(carrier.messages[0].find("number"), "2");
}

TEST_F(GatewayExportedWires, TheLastValueComesAgainAfterLongerAndLongerTimes) {
  put(a, 1);
  std::vector<int> published;
  for (int second = 0; second <= 20; ++second) {
    EXPECT_TRUE(wires.pump(carrier, now + seconds(second)));
    if (!carrier.take_topics().empty()) published.push_back(second);
  }
  EXPECT_THAT(published, ElementsAre(0, 1, 2, 4, 8, 16));
}

TEST_F(GatewayExportedWires, AreHeldToTheirPeriod) {
  auto slow = options("slow");
  slow.period = milliseconds(200);
  const Wire wire = wires.add(slow);
  put(wire, 1);
  EXPECT_TRUE(wires.pump(carrier, now));
  EXPECT_THAT(carrier.take_topics(), ElementsAre("slow"));
  put(wire, 2);
  EXPECT_TRUE(wires.pump(carrier, now + milliseconds(199)));
  EXPECT_THAT(carrier.take_topics(), ElementsAre());
  put(wire, 3);
  EXPECT_TRUE(wires.pump(carrier, now + milliseconds(200)));
  ASSERT_EQ(carrier.messages.size(), 1U);
  EXPECT_EQ(carrier.messages[0].payload, payload(3));
}

}  // namespace
}  // namespace rr::gateway
