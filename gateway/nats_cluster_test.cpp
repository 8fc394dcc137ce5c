// SPDX-License-Identifier: Apache-2.0
// A cluster of three servers of NATS, of which one at a time is killed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "gateway/carriers.hpp"
#include "gateway/nats_carrier.hpp"
#include "gateway/properties.hpp"
#include "gateway/testing/listener.hpp"
#include "gateway/testing/nats_server.hpp"
#include "gateway/testing/rig.hpp"

namespace rr::gateway {
namespace {

using std::chrono::milliseconds;
using testing::comes_true;
using testing::Kept;
using testing::Listener;
using testing::NatsServer;
using testing::Rig;

class NatsCluster : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_nats() || NatsServer::program().empty()) {
      GTEST_SKIP() << "libnats or nats-server is not installed";
    }
    std::vector<int> routes;
    for (auto& server : servers) {
      server = std::make_unique<NatsServer>();
      routes.push_back(server->route_port());
    }
    for (const auto& server : servers) {
      server->join(routes);
      server->configure({});
      server->start();
    }
  }
  /// All of them, the one with this number first.
  [[nodiscard]] std::string url(std::size_t first) const {
    std::string all;
    for (std::size_t i = 0; i < servers.size(); ++i) {
      all += (i == 0 ? "" : ",") + servers[(first + i) % servers.size()]->url(false);
    }
    return all;
  }

  std::array<std::unique_ptr<NatsServer>, 3> servers;
};

// Each of them in turn, so the leader of the stream is among them.
TEST_F(NatsCluster, NothingIsLostWhenServersAreKilled) {
  std::size_t made = 0;
  Rig rig([&] { return make_carriers({.url = url(made++), .replicas = 3}); }, milliseconds(60'000));
  const auto bench = rig.connect();
  auto samples = bench->pipe("samples").connect();
  Kept<std::uint32_t> got;
  const auto subscription =
      samples.on_packet([&](const dynamic::Value& packet) { got.add(packet.as<std::uint32_t>()); });
  auto force = bench->wire("force").connect();
  ASSERT_TRUE(comes_true([&] {
    rig.robot.bench().pipe("samples").send(0);
    return got.size() > 0;
  }));
  std::uint32_t last = 0;
  for (std::size_t killed = 0; killed < servers.size(); ++killed) {
    servers[killed]->kill();
    for (int i = 0; i < 500; ++i) rig.robot.bench().pipe("samples").send(++last);
    const double wanted = static_cast<double>(killed) + 1;
    rig.robot.bench().wire("force").set_in(wanted);
    // Two of three go on.
    ASSERT_TRUE(got.wait_for(last)) << killed << ::testing::PrintToString(rig.log.items());
    EXPECT_EQ(bench->call("add", {1, 2}).as<double>(), 3);
    EXPECT_TRUE(comes_true([&] {
      const auto value = force.try_in();
      return value && value->value.as<double>() == wanted;
    })) << killed;
    servers[killed]->start();
    // It has to have what the others have before the next one is killed.
    std::this_thread::sleep_for(milliseconds(3'000));
  }
  ASSERT_TRUE(comes_true([&] { return got.items().back() == last; }));
  std::uint32_t expected = 0;
  for (const std::uint32_t item : got.items()) {
    if (item == 0 && expected == 0) continue;
    ASSERT_EQ(item, ++expected);
  }
  EXPECT_EQ(expected, last);
  EXPECT_TRUE(samples.is_open());
  // A gateway that starts now finds the definitions at the servers.
  rig.stop_server();
  rig.start_server();
  EXPECT_EQ(rig.connect()->get("speed").as<double>(), 0.5);
}

// One of three servers is no majority: JetStream answers nothing there, and the rest goes on.
TEST_F(NatsCluster, MessagesGoOnWhileTheStreamHasNoLeader) {
  Listener heard;
  Listener ignored;
  const auto reader = make_nats_carrier({.url = url(0), .replicas = 3});
  const auto writer = make_nats_carrier({.url = url(1), .replicas = 3});
  reader->subscribe("rr/hall/#");
  reader->start(heard, {});
  writer->start(ignored, {});
  Message kept{"rr/hall/kept", bytes_of("kept")};
  kept.retained = true;
  ASSERT_TRUE(comes_true([&] { return writer->publish(kept) == Published::taken; }));
  ASSERT_TRUE(comes_true([&] { return heard.messages.size() > 0; }));
  servers[2]->kill();
  servers[0]->kill();
  ASSERT_TRUE(comes_true([&] { return heard.reasons.size() > 0; }));
  // Less than what a carrier gives a server for what is retained.
  const auto end = std::chrono::steady_clock::now() + milliseconds(10'000);
  const auto has_come = [&] {
    const auto all = heard.messages.items();
    return std::ranges::any_of(
        all, [](const Message& message) { return text_of(message.payload) == "new"; });
  };
  while (!has_come() && std::chrono::steady_clock::now() < end) {
    writer->publish({"rr/hall/new", bytes_of("new")});
    std::this_thread::sleep_for(milliseconds(50));
  }
  EXPECT_TRUE(has_come());
  reader->stop({});
  writer->stop({});
}

}  // namespace
}  // namespace rr::gateway
