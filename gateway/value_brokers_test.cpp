// SPDX-License-Identifier: Apache-2.0
// The two connections of a gateway to real brokers, over links that stand still.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <thread>

#include "gateway/properties.hpp"
#include "gateway/testing/broker_kinds.hpp"
#include "gateway/testing/listener.hpp"
#include "gateway/testing/relay.hpp"
#include "gateway/testing/rig.hpp"

namespace rr::gateway {
namespace {

using std::chrono::milliseconds;
using testing::comes_true;
using testing::Listener;
using testing::OverBroker;
using testing::RealBroker;
using testing::Relay;
using testing::Rig;
using testing::value_comes;

class BrokersValues : public OverBroker {
 protected:
  void SetUp() override {
    OverBroker::SetUp();
    if (IsSkipped()) return;
    broker = GetParam().start();
    const std::string url = broker->url();
    const int port = std::stoi(url.substr(url.rfind(':') + 1));
    messages = std::make_unique<Relay>(port);
    values = std::make_unique<Relay>(port);
    rig.emplace([this, url]() -> Carriers {
      return {make_carriers({messages->url(url)}).messages,
              make_carriers({values->url(url)}).values};
    });
    bench = rig->connect();
    force = bench->wire("force").connect();
    set(1);
    ASSERT_TRUE(value_comes(force, 1));
  }
  void set(double value) { rig->robot.bench().wire("force").set_in(value); }

  std::unique_ptr<RealBroker> broker;
  // Links of both gateways.
  std::unique_ptr<Relay> messages;
  std::unique_ptr<Relay> values;
  std::optional<Rig> rig;
  dynamic::Client bench;
  dynamic::WireConnection force;
};

TEST_P(BrokersValues, ArriveWhileMessagesStandStill) {
  for (int i = 0; i < 100; ++i) rig->robot.bench().pipe("samples").send(i);
  messages->stand_still(true);
  for (int i = 0; i < 1'000; ++i) rig->robot.bench().pipe("samples").send(i);
  for (int i = 2; i <= 20; ++i) {
    set(i);
    ASSERT_TRUE(value_comes(force, i)) << i;
  }
  messages->stand_still(false);
  EXPECT_EQ(bench->call("count").as<int>(), 1);
}

TEST_P(BrokersValues, RequestsGoOnWhileValuesStandStill) {
  values->stand_still(true);
  for (int i = 2; i <= 100; ++i) set(i);
  EXPECT_EQ(bench->call("count").as<int>(), 1);
  EXPECT_EQ(bench->get("speed").as<double>(), 0.5);
  values->stand_still(false);
  EXPECT_TRUE(value_comes(force, 100));
}

// What is under way when the link stands still is delivered after it, however old it is by then.
TEST_P(BrokersValues, ALinkThatStoodStillCarriesFewOldValues) {
  const std::string topic = "rr/hall/robot/bench/force";
  Listener reader;
  const auto carrier = make_carrier({broker->url()});
  carrier->subscribe(topic);
  carrier->start(reader, {});
  ASSERT_TRUE(reader.messages.wait_for(1));
  values->stand_still(true);
  const std::size_t before = reader.messages.size();
  constexpr int count = 400;
  for (int i = 2; i <= count; ++i) {
    set(i);
    // Each of them reaches the gateway by itself.
    std::this_thread::sleep_for(milliseconds(2));
  }
  values->stand_still(false);
  EXPECT_TRUE(value_comes(force, count));
  // 16 in flight, and those that the gateway was still to get from the robot or repeats.
  EXPECT_LE(reader.messages.size(), before + 16 + 10);
  carrier->stop({});
}

INSTANTIATE_TEST_SUITE_P(All, BrokersValues, ::testing::ValuesIn(testing::broker_kinds()),
                         testing::name_of_kind);

}  // namespace
}  // namespace rr::gateway
