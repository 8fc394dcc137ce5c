// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "rr/discovery.hpp"
#include "rr/node.hpp"
#include "runtime/cpp/src/discovery/testing.hpp"
#include "runtime/cpp/src/node/testing/counter.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/wired.hpp"

namespace rr::discovery {
namespace {

using namespace std::chrono_literals;
using rr::testing::Counter;
using rr::testing::CounterStub;
using rr::testing::error_of;
using rr::testing::eventually;

class TypeSubscriptions : public ::testing::Test {
 protected:
  TypeSubscriptions() { client_.discovery().listen(listening_at(network_)); }

  /// A node with a counter of a colour.
  std::unique_ptr<Node> serve(const std::string& name, const std::string& color) {
    auto node = std::make_unique<Node>(NodeOptions{.name = name});
    node->register_service("counter", std::make_shared<Counter>(name),
                           {.attributes = {{"color", color}}});
    node->listen_tcp(0, "127.0.0.1");
    node->discovery().announce({.network = network_, .period = 500ms});
    return node;
  }
  static std::size_t count(const ServiceSubscription& subscription) {
    return subscription.connected_clients().size();
  }

  DiscoveryNetwork network_ = loopback_network();
  Node client_;
};

TEST_F(TypeSubscriptions, ConnectToServicesThatComeAndGo) {
  ServiceSubscription counters = client_.subscribe_type("test.counter.Counter");
  EXPECT_EQ(counters.try_default_client<CounterStub>(), nullptr);
  auto one = serve("one", "red");
  EXPECT_EQ(counters.wait_default_client<CounterStub>(10s)->get_name(), "one");
  auto two = serve("two", "blue");
  ASSERT_TRUE(eventually([&] { return count(counters) == 2; }));
  one.reset();
  ASSERT_TRUE(eventually([&] { return count(counters) == 1; }));
  EXPECT_EQ(counters.default_client<CounterStub>()->get_name(), "two");
  counters.close();
  EXPECT_EQ(count(counters), 0U);
}

TEST_F(TypeSubscriptions, TakeWhatImplementsTheType) {
  const auto one = serve("one", "red");
  ServiceSubscription named = client_.subscribe_types({"test.counter.Named", "some.Other"});
  EXPECT_EQ(named.wait_default_client<CounterStub>(10s)->get_name(), "one");
  ServiceSubscription other = client_.subscribe_type("some.Other");
  EXPECT_EQ(error_of([&] { (void)other.wait_default_client<CounterStub>(1s); }).code(),
            ErrorCode::operation_timeout);
}

TEST_F(TypeSubscriptions, HaveFiltersThatCanBeExchanged) {
  const auto red = serve("one", "red");
  const auto blue = serve("two", "blue");
  ServiceFilter filter;
  filter.attributes["color"].tests = {{.value = "red"}};
  ServiceSubscription counters = client_.subscribe_type("test.counter.Counter", {.filter = filter});
  const auto is_only = [&](const Node& node) {
    const auto clients = counters.connected_clients();
    return clients.size() == 1 && clients[0].node == node.id();
  };
  ASSERT_TRUE(eventually([&] { return is_only(*red); }));
  filter.attributes["color"].tests = {{.value = "blue"}};
  counters.update_types({"test.counter.Counter"}, filter);
  ASSERT_TRUE(eventually([&] { return is_only(*blue); }));
  counters.update_types({}, {.service_names = {"counter"}});
  ASSERT_TRUE(eventually([&] { return count(counters) == 2; }));
}

TEST_F(TypeSubscriptions, FollowAttributesThatChange) {
  Node node;
  Service service = node.register_service("counter", std::make_shared<Counter>(),
                                          {.attributes = {{"state", "busy"}}});
  node.listen_tcp(0, "127.0.0.1");
  node.discovery().announce({.network = network_, .period = 500ms});
  std::atomic<int> asked = 0;
  ServiceSubscription counters = client_.subscribe_type(
      "test.counter.Counter", {.filter = {.predicate = [&](const FoundService& found) {
                                 ++asked;
                                 return found.attributes.at("state") == VarValue("free");
                               }}});
  ASSERT_TRUE(eventually([&] { return asked > 0; }));
  EXPECT_EQ(count(counters), 0U);
  service->set_attributes({{"state", "free"}});
  ASSERT_TRUE(eventually([&] { return count(counters) == 1; }));
  service->set_attributes({{"state", "busy"}});
  ASSERT_TRUE(eventually([&] { return count(counters) == 0; }));
  counters.close();
}

TEST_F(TypeSubscriptions, KeepAConnectionWhoseNodeIsNotHeardAnyMore) {
  ListenOptions options = listening_at(network_);
  options.lifetime = 1500ms;
  client_.discovery().listen(options);
  auto one = serve("one", "red");
  ServiceSubscription counters = client_.subscribe_type("test.counter.Counter");
  ASSERT_TRUE(eventually([&] { return count(counters) == 1; }));
  one->discovery().stop_announcing();
  ASSERT_TRUE(eventually([&] { return client_.discovery().detected_nodes().empty(); }));
  EXPECT_EQ(count(counters), 1U);
  one.reset();
  ASSERT_TRUE(eventually([&] { return counters.services().empty(); }));
}

TEST_F(TypeSubscriptions, HaveWiresThatFollowTheServices) {
  ServiceSubscription any = client_.subscribe_types({}, {.filter = {.service_names = {"wired"}}});
  any.use_types<rr::testing::WiredStub>();
  WireSubscription<double> level = any.subscribe_wire<double>("level");
  Node node;
  const auto object = std::make_shared<rr::testing::Wired>();
  node.register_service("wired", object);
  node.listen_tcp(0, "127.0.0.1");
  node.discovery().announce({.network = network_, .period = 500ms});
  ASSERT_TRUE(eventually([&] { return level.clients().size() == 1; }));
  object->level().set_in(0.25);
  ASSERT_TRUE(level.wait_in(10s));
  EXPECT_EQ(level.in(), 0.25);
}

TEST_F(TypeSubscriptions, AreNotThoseOfUrls) {
  ServiceSubscription url = client_.subscribe("rr+tcp://127.0.0.1:1/?service=x");
  EXPECT_EQ(error_of([&] { url.update_types({"a.B"}); }).code(), ErrorCode::invalid_operation);
  ServiceFilter wrong;
  wrong.attributes["a"].tests = {{.value = "(", .is_expression = true}};
  EXPECT_EQ(error_of([&] { (void)client_.subscribe_type("a.B", {.filter = wrong}); }).code(),
            ErrorCode::invalid_argument);
}

}  // namespace
}  // namespace rr::discovery
