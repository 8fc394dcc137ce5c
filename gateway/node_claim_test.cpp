// SPDX-License-Identifier: Apache-2.0
#include "gateway/node_claim.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gateway/properties.hpp"

namespace rr::gateway {
namespace {

using State = NodeClaim::State;
using std::chrono::milliseconds;

/// Gateways of one node, and the broker between them with a clock of its own.
class Broker {
 public:
  NodeClaim& start(std::int64_t started, const std::string& host) {
    claims_.push_back(std::make_unique<NodeClaim>("rr/hall/robot", started, host));
    return *claims_.back();
  }
  void connect(NodeClaim& claim) {
    connected_.push_back(&claim);
    claim.connected();
    if (retained) claim.take(with(*retained, true), now);
  }
  /// The retained life is delivered while other subscriptions are not confirmed.
  void connect_late(NodeClaim& claim) {
    connected_.push_back(&claim);
    if (retained) claim.take(with(*retained, true), now);
    claim.connected();
  }
  /// Without a word; the broker may publish the last will.
  void lose(NodeClaim& claim, bool says_so) {
    std::erase(connected_, &claim);
    claim.disconnected();
    if (says_so) publish(claim.life("lost"));
  }
  void publish(const Message& message) {
    if (message.retained) retained = message;
    for (NodeClaim* claim : connected_) claim->take(with(message, false), now);
  }
  void run(milliseconds time) {
    for (const auto end = now + time; now < end; now += milliseconds(20)) {
      for (NodeClaim* claim : connected_) {
        while (const auto message = claim->next(now)) publish(*message);
      }
    }
  }
  [[nodiscard]] std::string life() const { return retained ? text_of(retained->payload) : ""; }
  [[nodiscard]] std::string host() const {
    return retained ? std::string(retained->find("host").value_or("")) : "";
  }

  std::optional<Message> retained;
  NodeClaim::Clock::time_point now = NodeClaim::Clock::now();

 private:
  static Message with(Message message, bool is_retained) {
    message.retained = is_retained;
    return message;
  }
  std::vector<std::unique_ptr<NodeClaim>> claims_;
  std::vector<NodeClaim*> connected_;
};

TEST(GatewayNodeClaim, AFreeNodeIsTakenAtOnce) {
  Broker broker;
  NodeClaim& one = broker.start(1'000, "one");
  EXPECT_EQ(one.state(), State::away);
  broker.connect(one);
  EXPECT_EQ(one.state(), State::asking);
  broker.run(milliseconds(60));
  EXPECT_EQ(one.state(), State::holding);
  EXPECT_EQ(broker.life(), "up");
  EXPECT_EQ(broker.host(), "one");
}

TEST(GatewayNodeClaim, ASecondGatewayIsRefused) {
  Broker broker;
  NodeClaim& one = broker.start(1'795'779'856'000'000'000, "one");
  broker.connect(one);
  broker.run(milliseconds(1'000));
  // Whenever it says that it was started.
  NodeClaim& two = broker.start(5, "two");
  broker.connect(two);
  broker.run(milliseconds(1'000));
  EXPECT_EQ(one.state(), State::holding);
  EXPECT_EQ(two.state(), State::refused);
  EXPECT_EQ(two.holder(), "one, since 2026-11-27T11:44:16Z");
  EXPECT_EQ(broker.host(), "one");
  // For good, also when it connects again.
  broker.lose(two, false);
  broker.connect(two);
  broker.run(milliseconds(5'000));
  EXPECT_EQ(two.state(), State::refused);
}

TEST(GatewayNodeClaim, TheNodeOfAGatewayThatHasGoneIsTaken) {
  Broker broker;
  NodeClaim& one = broker.start(1'000, "one");
  broker.connect(one);
  broker.run(milliseconds(1'000));
  broker.lose(one, true);
  EXPECT_EQ(broker.life(), "lost");
  NodeClaim& two = broker.start(2'000, "two");
  broker.connect(two);
  broker.run(milliseconds(60));
  EXPECT_EQ(two.state(), State::holding);
  EXPECT_EQ(broker.host(), "two");
}

TEST(GatewayNodeClaim, ARetainedLifeMayComeBeforeTheConnection) {
  Broker broker;
  NodeClaim& first = broker.start(1, "one");
  broker.connect(first);
  broker.run(milliseconds(100));
  ASSERT_EQ(first.state(), State::holding);
  broker.lose(first, false);
  NodeClaim& second = broker.start(2, "two");
  broker.connect_late(second);
  broker.run(milliseconds(1500));
  EXPECT_EQ(second.state(), State::asking);
  broker.run(milliseconds(1500));
  EXPECT_EQ(second.state(), State::holding);
}

TEST(GatewayNodeClaim, TheNodeOfAGatewayThatHasGoneWithoutAWordIsTakenLater) {
  Broker broker;
  NodeClaim& one = broker.start(1'000, "one");
  broker.connect(one);
  broker.run(milliseconds(1'000));
  broker.lose(one, false);
  NodeClaim& two = broker.start(2'000, "two");
  broker.connect(two);
  broker.run(milliseconds(1'500));
  EXPECT_EQ(two.state(), State::asking);
  EXPECT_EQ(broker.host(), "one");
  broker.run(milliseconds(1'500));
  EXPECT_EQ(two.state(), State::holding);
  EXPECT_EQ(broker.host(), "two");
  // The broker notices the loss now.
  broker.publish(one.life("lost"));
  broker.run(milliseconds(500));
  EXPECT_EQ(broker.life(), "up");
  EXPECT_EQ(broker.host(), "two");
  // The one that was away finds the node taken.
  broker.connect(one);
  broker.run(milliseconds(1'000));
  EXPECT_EQ(one.state(), State::refused);
  EXPECT_EQ(two.state(), State::holding);
}

TEST(GatewayNodeClaim, OfTwoThatTakeItAtOnceTheLaterOneLoses) {
  for (const bool first_is_older : {true, false}) {
    Broker broker;
    NodeClaim& one = broker.start(first_is_older ? 1'000 : 3'000, "one");
    NodeClaim& two = broker.start(2'000, "two");
    one.connected();
    two.connected();
    // Neither hears the other until both have the node.
    one.take(*one.next(broker.now), broker.now);
    two.take(*two.next(broker.now), broker.now);
    const Message life_one = *one.next(broker.now);
    const Message life_two = *two.next(broker.now);
    ASSERT_EQ(one.state(), State::holding);
    ASSERT_EQ(two.state(), State::holding);
    one.take(life_two, broker.now);
    two.take(life_one, broker.now);
    EXPECT_EQ(one.state(), first_is_older ? State::holding : State::refused);
    EXPECT_EQ(two.state(), first_is_older ? State::refused : State::holding);
  }
}

TEST(GatewayNodeClaim, TheHolderTakesItAgainAfterTheBrokerHasForgottenAll) {
  Broker broker;
  NodeClaim& one = broker.start(1'000, "one");
  broker.connect(one);
  broker.run(milliseconds(1'000));
  broker.lose(one, false);
  broker.retained.reset();
  broker.connect(one);
  broker.run(milliseconds(60));
  EXPECT_EQ(one.state(), State::holding);
  EXPECT_EQ(broker.life(), "up");
}

}  // namespace
}  // namespace rr::gateway
