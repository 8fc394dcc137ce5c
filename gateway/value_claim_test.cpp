// SPDX-License-Identifier: Apache-2.0
#include "gateway/value_claim.hpp"

#include <gtest/gtest.h>

#include "gateway/properties.hpp"

namespace rr::gateway {
namespace {

using std::chrono::milliseconds;
using State = NodeClaim::State;

/// A gateway's claims, and the life of another gateway.
class GatewayValueClaim : public ::testing::Test {
 protected:
  /// The broker has nothing of another gateway: the node is this one's.
  void take_node() {
    claim.connected();
    const auto asked = claim.next(now);
    ASSERT_TRUE(asked.has_value());
    claim.take(*asked, now);
    ASSERT_TRUE(claim.next(now).has_value());
    ASSERT_EQ(claim.state(), State::holding);
  }

  NodeClaim::Clock::time_point now = NodeClaim::Clock::now();
  NodeClaim claim{"rr/hall/robot", 2'000, "one"};
  NodeClaim other{"rr/hall/robot", 3'000, "two"};
  ValueClaim values{claim};
};

TEST_F(GatewayValueClaim, NothingIsAllowedBeforeTheNodeIsHeld) {
  EXPECT_FALSE(values.update());
  values.connected();
  EXPECT_FALSE(values.update());
  claim.connected();
  EXPECT_FALSE(values.update());
  EXPECT_FALSE(values.allows());
  take_node();
  EXPECT_TRUE(values.update());
  EXPECT_TRUE(values.allows());
  EXPECT_FALSE(values.update());
}

TEST_F(GatewayValueClaim, NeedsItsConnection) {
  take_node();
  EXPECT_FALSE(values.update());
  values.connected();
  EXPECT_TRUE(values.update());
  values.disconnected();
  EXPECT_FALSE(values.update());
  EXPECT_FALSE(values.allows());
  values.connected();
  EXPECT_TRUE(values.update());
}

TEST_F(GatewayValueClaim, GoesOnWithoutTheConnectionForMessages) {
  take_node();
  values.connected();
  EXPECT_TRUE(values.update());
  claim.disconnected();
  EXPECT_FALSE(values.update());
  EXPECT_TRUE(values.allows());
  claim.connected();
  EXPECT_FALSE(values.update());
  EXPECT_TRUE(values.allows());
}

TEST_F(GatewayValueClaim, ANewConnectionWaitsForTheNode) {
  take_node();
  values.connected();
  EXPECT_TRUE(values.update());
  claim.disconnected();
  values.disconnected();
  EXPECT_FALSE(values.update());
  values.connected();
  EXPECT_FALSE(values.update());
  EXPECT_FALSE(values.allows());
  take_node();
  EXPECT_TRUE(values.update());
}

TEST_F(GatewayValueClaim, EndsWhenAnotherGatewayIsUp) {
  take_node();
  values.connected();
  EXPECT_TRUE(values.update());
  claim.disconnected();
  values.take(claim.life("up"));
  values.take(other.life("lost"));
  EXPECT_FALSE(values.update());
  EXPECT_TRUE(values.allows());
  values.take(other.life("up"));
  EXPECT_FALSE(values.update());
  EXPECT_FALSE(values.allows());
  // The node is nobody's, until this gateway holds it.
  values.take(other.life("ended"));
  EXPECT_FALSE(values.update());
  EXPECT_FALSE(values.allows());
  take_node();
  EXPECT_TRUE(values.update());
}

TEST_F(GatewayValueClaim, ADisputeEndsWithTheLifeOfThisGateway) {
  take_node();
  values.connected();
  EXPECT_TRUE(values.update());
  EXPECT_FALSE(values.wants_life(now));
  values.take(other.life("up"));
  EXPECT_FALSE(values.update());
  EXPECT_FALSE(values.allows());
  EXPECT_TRUE(values.wants_life(now));
  EXPECT_FALSE(values.wants_life(now + milliseconds(999)));
  EXPECT_TRUE(values.wants_life(now + milliseconds(1'000)));
  claim.repeat_life();
  now += milliseconds(1'000);
  const auto life = claim.next(now);
  ASSERT_TRUE(life.has_value());
  values.take(*life);
  EXPECT_TRUE(values.update());
  EXPECT_FALSE(values.wants_life(now + milliseconds(5'000)));
}

TEST_F(GatewayValueClaim, ARefusedGatewayHasNoValues) {
  take_node();
  values.connected();
  EXPECT_TRUE(values.update());
  NodeClaim first("rr/hall/robot", 1'000, "first");
  claim.take(first.life("up"), now);
  ASSERT_EQ(claim.state(), State::refused);
  EXPECT_FALSE(values.update());
  EXPECT_FALSE(values.allows());
  values.take(first.life("ended"));
  values.disconnected();
  values.connected();
  EXPECT_FALSE(values.update());
  EXPECT_FALSE(values.allows());
}

}  // namespace
}  // namespace rr::gateway
