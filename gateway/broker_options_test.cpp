// SPDX-License-Identifier: Apache-2.0
#include "gateway/broker_options.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "rr/error.hpp"

namespace rr::gateway {
namespace {

constexpr std::array<BrokerScheme, 2> schemes{{{"mqtt", false, 1883}, {"mqtts", true, 8883}}};

std::string parts(const std::string& url) {
  const BrokerPlace place = place_of(BrokerOptions{url}, schemes);
  return place.host + " " + std::to_string(place.port) + (place.is_encrypted ? " TLS" : "");
}

TEST(GatewayBrokerUrl, HasHostAndPort) {
  EXPECT_EQ(parts("mqtt://hub"), "hub 1883");
  EXPECT_EQ(parts("mqtt://hub:1"), "hub 1");
  EXPECT_EQ(parts("mqtts://hub.example"), "hub.example 8883 TLS");
  EXPECT_EQ(parts("mqtts://127.0.0.1:65535"), "127.0.0.1 65535 TLS");
  EXPECT_EQ(parts("mqtt://[::1]"), "::1 1883");
  EXPECT_EQ(parts("mqtt://[::1]:2"), "::1 2");
}

TEST(GatewayBrokerUrl, OthersAreRefused) {
  for (const char* url : {"", "hub", "mqtt:", "mqtt://", "http://hub", "mqtt://hub:0",
                          "mqtt://hub:65536", "mqtt://hub:x", "mqtt://hub:", "mqtt://hub/path",
                          "mqtt://user@hub", "mqtt://[::1", "mqtt://[::1]x", "mqtt://::1"}) {
    EXPECT_THROW(static_cast<void>(parts(url)), Error) << url;
  }
}

TEST(GatewayBrokerUrl, FilesOfTlsNeedTls) {
  for (const BrokerOptions& broker : {BrokerOptions{.url = "mqtt://hub", .authority = "x"},
                                      BrokerOptions{.url = "mqtt://hub", .certificate = "x"},
                                      BrokerOptions{.url = "mqtt://hub", .key = "x"}}) {
    EXPECT_THROW(static_cast<void>(place_of(broker, schemes)), Error);
  }
}

}  // namespace
}  // namespace rr::gateway
