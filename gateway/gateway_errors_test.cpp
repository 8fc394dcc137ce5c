// SPDX-License-Identifier: Apache-2.0
// What goes wrong around gateways, each with its error.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>

#include "gateway/properties.hpp"
#include "gateway/testing/listener.hpp"
#include "gateway/testing/memory_broker.hpp"
#include "gateway/testing/rig.hpp"
#include "rr/locks.hpp"

namespace rr::gateway {
namespace {

using std::chrono::milliseconds;
using testing::BenchService;
using testing::comes_true;
using testing::Folder;
using ::testing::HasSubstr;
using testing::Kept;
using testing::MemoryBroker;
using testing::Rig;

Log into(Kept<std::string>& lines) {
  return [&lines](LogLevel, const std::string& text) { lines.add(text); };
}

bool has_line(const Kept<std::string>& lines, const std::string& part) {
  const auto all = lines.items();
  return std::ranges::any_of(
      all, [&](const auto& line) { return line.find(part) != std::string::npos; });
}

template <class Call>
Error failure_of(Call call) {
  try {
    static_cast<void>(call());
  } catch (const Error& error) {
    return error;
  }
  return {ErrorCode::none, "no error"};
}

TEST(GatewayErrors, ASecondGatewayOfARobotIsRefused) {
  MemoryBroker broker;
  Rig rig([&] { return broker.carriers(); });
  const auto bench = rig.connect();
  EXPECT_EQ(bench->call("count").as<int>(), 1);
  const Folder state;
  const Carriers carriers = broker.carriers();
  Kept<std::string> log;
  Kept<std::string> refused;
  {
    const Exporter second(rig.export_file(state.path()), carriers, into(log),
                          [&](const std::string& reason) { refused.add(reason); });
    ASSERT_TRUE(refused.wait_for(1));
    EXPECT_THAT(refused.items()[0], HasSubstr("another gateway serves hall/robot at memory: "));
    EXPECT_TRUE(has_line(log, refused.items()[0]));
    // It executes nothing, also while it is there.
    for (int i = 2; i <= 20; ++i) EXPECT_EQ(bench->call("count").as<int>(), i);
  }
  EXPECT_EQ(rig.robot.counted(), 20);
  const auto life = broker.retained("rr/hall/robot/$life");
  ASSERT_TRUE(life.has_value());
  EXPECT_EQ(text_of(life->payload), "up");
  EXPECT_EQ(refused.size(), 1U);
}

TEST(GatewayErrors, ASecondGatewayWithTheSameStateDoesNotStart) {
  MemoryBroker broker;
  Rig rig([&] { return broker.carriers(); });
  const Carriers carriers = broker.carriers();
  Kept<std::string> log;
  const Error error = failure_of(
      [&] { return Exporter(rig.export_file(rig.state_folder()), carriers, into(log)), 0; });
  EXPECT_EQ(error.code(), ErrorCode::invalid_state);
  EXPECT_THAT(error.message(), HasSubstr("is in use by another gateway"));
}

TEST(GatewayErrors, AGatewayTakesTheNodeOfOneThatHasGone) {
  MemoryBroker broker;
  Rig rig([&] { return broker.carriers(); });
  const auto bench = rig.connect();
  EXPECT_EQ(bench->call("count").as<int>(), 1);
  rig.stop_export();
  // As a broker that was killed with the robot may have it.
  const auto other = broker.carrier();
  testing::Listener listener;
  other->start(listener, {});
  ASSERT_TRUE(listener.connected.wait_for(1));
  Message life{"rr/hall/robot/$life", bytes_of("up")};
  life.properties = {{"instance", "gone"}, {"started", "1"}, {"host", "gone"}};
  life.retained = true;
  ASSERT_EQ(other->publish(life), Published::taken);
  rig.start_export();
  EXPECT_EQ(bench->call("count").as<int>(), 2);
  other->stop({});
}

// The rules of this rig have no access `lock`.
TEST(GatewayErrors, LocksThatAreNotExportedAreRefusedAndThoseOfNearClientsHold) {
  MemoryBroker broker;
  Rig rig([&] { return broker.carriers(); });
  const auto bench = rig.connect();
  const Error refused = failure_of([&] { return lock(bench->stub()), 0; });
  EXPECT_EQ(refused.code(), ErrorCode::permission_denied);
  EXPECT_EQ(bench->get("speed").as<double>(), 0.5);

  Node near_node;
  auto login = Rig::login();
  login.username = "operator";
  const auto near = dynamic::connect(near_node, rig.robot.url(), login);
  lock(near->stub());
  const Error locked = failure_of([&] { return bench->set("speed", 1.0), 0; });
  EXPECT_EQ(locked.code(), ErrorCode::object_locked_error);
  unlock(near->stub());
  bench->set("speed", 1.0);
  EXPECT_EQ(rig.robot.bench().stored("speed").as<double>(), 1.0);
}

/// A robot whose definition changes while both gateways run.
TEST(GatewayErrors, AChangedDefinitionEndsTheServiceUntilTheServingGatewayIsStartedAgain) {
  MemoryBroker broker;
  const Folder state;
  Kept<std::string> export_log;
  Kept<std::string> serve_log;
  auto robot = std::make_unique<BenchService>();
  const std::uint16_t port = robot->port();
  ExportFile file;
  file.site = "hall";
  file.node = "robot";
  file.state_folder = state.path();
  file.services.emplace_back();
  file.services[0].name = "bench";
  file.services[0].url = robot->url();
  file.services[0].login = {"gateway", "open sesame"};
  ExportRule all;
  all.members = {"*"};
  all.access = reading | writing | calling;
  file.services[0].rules.push_back(all);
  const Carriers export_carriers = broker.carriers();
  const Exporter exporter(file, export_carriers, into(export_log));

  ServerOptions options;
  options.services = {{{"hall", "robot", "bench"}, "bench"}};
  options.reader = "hub";
  Carriers carriers;
  std::unique_ptr<Node> node;
  std::optional<Server> server;
  Node client_node;
  const auto start_server = [&] {
    node = std::make_unique<Node>();
    const auto to = "rr+tcp://localhost:" + std::to_string(node->listen_tcp(0)) + "/?service=bench";
    carriers = broker.carriers();
    server.emplace(options, *node, carriers, into(serve_log));
    dynamic::Client client;
    EXPECT_TRUE(comes_true([&] {
      return failure_of([&] { return client = dynamic::connect(client_node, to), 0; }).code() ==
             ErrorCode::none;
    }));
    return client;
  };
  const auto bench = start_server();
  EXPECT_EQ(bench->get("secret").as<int>(), 7);

  robot.reset();
  std::string changed = testing::bench_definition;
  changed.replace(changed.find("int32 secret"), 12, "double secret");
  ASSERT_TRUE(comes_true([&] {
    return failure_of([&] {
             robot = std::make_unique<BenchService>(changed, port);
             return 0;
           }).code() == ErrorCode::none;
  }));
  EXPECT_TRUE(comes_true([&] {
    return has_line(serve_log, "rr/hall/robot/bench: the definition has changed");
  })) << ::testing::PrintToString(export_log.items());
  const Error error = failure_of([&] { return bench->get("secret"); });
  EXPECT_NE(error.code(), ErrorCode::none);
  EXPECT_NE(error.code(), ErrorCode::request_timeout) << error.what();

  server.reset();
  node.reset();
  Node other_client;
  const auto again = start_server();
  EXPECT_EQ(again->member("secret").type.text(), "double");
  EXPECT_EQ(again->get("secret").as<double>(), 7);
}

}  // namespace
}  // namespace rr::gateway
