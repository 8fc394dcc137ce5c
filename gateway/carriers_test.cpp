// SPDX-License-Identifier: Apache-2.0
#include "gateway/carriers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "rr/error.hpp"

namespace rr::gateway {
namespace {

using ::testing::HasSubstr;

std::string carrier_mistake(const BrokerOptions& broker) {
  try {
    static_cast<void>(make_carrier(broker));
  } catch (const Error& error) {
    return error.message();
  }
  return "none";
}

TEST(GatewayCarriers, FollowFromTheUrl) {
  EXPECT_EQ(carrier_mistake({.url = "mqtt://hub"}), "none");
  EXPECT_EQ(carrier_mistake({.url = "mqtts://hub:8884"}), "none");
  for (const char* url : {"", "hub", "http://hub", "mqtt:hub", "natss://hub"}) {
    EXPECT_EQ(carrier_mistake({.url = url}),
              "`" + std::string(url) +
                  "` is no broker: its URL begins with mqtt://, mqtts://, nats:// or tls://");
  }
}

TEST(GatewayCarriers, AreTwoOfAGateway) {
  const Carriers carriers = make_carriers({.url = "mqtt://hub"});
  EXPECT_EQ(carriers.messages->url(), "mqtt://hub");
  EXPECT_EQ(carriers.values->url(), "mqtt://hub");
  EXPECT_THROW(static_cast<void>(make_carriers({.url = "http://hub"})), Error);
}

TEST(GatewayCarriers, RefuseOptionsOfAnotherBroker) {
  for (const BrokerOptions& broker :
       {BrokerOptions{.url = "mqtt://hub", .token = "secret"},
        BrokerOptions{.url = "mqtt://hub", .credentials = "robot.creds"},
        BrokerOptions{.url = "mqtt://hub", .replicas = 3}}) {
    EXPECT_THAT(carrier_mistake(broker), HasSubstr("is a broker of MQTT"));
  }
}

}  // namespace
}  // namespace rr::gateway
