// SPDX-License-Identifier: Apache-2.0
// Which services a subscription takes, and clients that are claimed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "rr/subscription.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/process_state.hpp"
#include "runtime/cpp/src/node/testing/server.hpp"
#include "runtime/cpp/src/node/testing/silent_peer.hpp"
#include "runtime/cpp/src/subscription/filter.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

SubscriptionOptions with(ServiceFilter filter) {
  return {.retry_delay = 20ms, .filter = std::move(filter)};
}

// Claims

TEST(ClaimedClients, StayWhenTheSubscriptionIsClosed) {
  Server server("counter", counter("a"));
  Node node;
  auto subscription = node.subscribe(server.url(), with({}));
  const auto stub = subscription.wait_default_client<CounterStub>(20s);
  auto client = subscription.claim_client(stub);
  EXPECT_EQ(client->get_name(), "a");
  EXPECT_EQ(code_of([&] { (void)subscription.claim_client(stub); }), ErrorCode::invalid_operation);
  EXPECT_EQ(subscription.connected_clients().size(), 1U);
  subscription.close();
  EXPECT_TRUE(client.is_open());
  EXPECT_EQ(client->get_name(), "a");
  subscription.release_client(std::move(client));
  EXPECT_TRUE(eventually([&] { return server.client_count() == 0; }));
}

TEST(ClaimedClients, GoBackToTheSubscription) {
  Server server("counter", counter("a"));
  Node node;
  auto subscription = node.subscribe(server.url(), with({}));
  const auto stub = subscription.wait_default_client<CounterStub>(20s);
  auto client = subscription.claim_client(stub);
  subscription.release_client(std::move(client));
  EXPECT_FALSE(client.is_open());  // NOLINT: it has no session any more
  EXPECT_EQ(subscription.default_client<CounterStub>(), stub);
  EXPECT_EQ(stub->get_name(), "a");
  EXPECT_EQ(code_of([&] { subscription.release_client(std::move(client)); }),
            ErrorCode::invalid_argument);
  auto other = node.connect<CounterStub>(server.url());
  EXPECT_EQ(code_of([&] { subscription.release_client(std::move(other)); }),
            ErrorCode::invalid_argument);
  EXPECT_TRUE(other.is_open());  // NOLINT: it was not taken
  EXPECT_EQ(code_of([&] { (void)subscription.claim_client(other.stub()); }),
            ErrorCode::invalid_argument);
  subscription.close();
  EXPECT_TRUE(eventually([&] { return server.client_count() == 1; }));
}

TEST(ClaimedClients, AreReplacedWhenTheirClaimerClosesThem) {
  Server server("counter", counter("a"));
  Node node;
  auto subscription = node.subscribe(server.url(), with({}));
  const auto stub = subscription.wait_default_client<CounterStub>(20s);
  subscription.claim_client(stub).close();
  EXPECT_TRUE(eventually([&] {
    const auto now = subscription.try_default_client<CounterStub>();
    return now && now != stub;
  }));
  EXPECT_EQ(code_of([&] { (void)subscription.claim_client(stub); }), ErrorCode::invalid_argument);
}

// Filters

struct Camera {
  explicit Camera(const std::string& node_name)
      : server("counter", counter(node_name), {.name = node_name},
               {.attributes = {{"color", std::string("red, blue")},
                               {"place", VarStringMap{{"room", std::string("b12")}}},
                               {"size", 5}}}) {}
  Server server;
  Node node;

  bool is_taken(ServiceFilter filter) {
    auto subscription = node.subscribe(server.url(), with(std::move(filter)));
    EXPECT_TRUE(eventually(
        [&] { return !subscription.connected_clients().empty() || subscription.last_error(); }));
    const bool result = !subscription.connected_clients().empty();
    if (!result) {
      EXPECT_EQ(subscription.last_error()->code(), ErrorCode::service_not_found);
      EXPECT_THAT(subscription.last_error()->message(), HasSubstr("filter"));
    }
    subscription.close();
    return result;
  }
};

TEST(ServiceFilters, TakeNodesByIdAndName) {
  Camera camera("camera.left");
  EXPECT_TRUE(camera.is_taken({.nodes = {{.name = "camera.left"}}}));
  EXPECT_TRUE(camera.is_taken({.nodes = {{.name = "x"}, {.id = camera.server.id()}}}));
  EXPECT_FALSE(camera.is_taken({.nodes = {{.name = "camera.right"}}}));
  EXPECT_FALSE(camera.is_taken({.nodes = {{.id = NodeId::random()}}}));
  EXPECT_FALSE(camera.is_taken({.nodes = {{.id = camera.server.id(), .name = "x"}}}));
  EXPECT_TRUE(eventually([&] { return camera.server.client_count() == 0; }));
}

TEST(ServiceFilters, TakeServicesAndSchemes) {
  Camera camera("camera");
  EXPECT_TRUE(camera.is_taken({.service_names = {"other", "counter"}}));
  EXPECT_FALSE(camera.is_taken({.service_names = {"other"}}));
  EXPECT_TRUE(camera.is_taken({.transport_schemes = {"rr+local", "rr+tcp"}}));
  EXPECT_FALSE(camera.is_taken({.transport_schemes = {"rr+local"}}));
}

TEST(ServiceFilters, TakeAttributesOfTheService) {
  Camera camera("camera");
  EXPECT_TRUE(camera.is_taken({.attributes = {{"color", {.tests = {{.value = "blue"}}}}}}));
  EXPECT_FALSE(camera.is_taken({.attributes = {{"color", {.tests = {{.value = "green"}}}}}}));
  EXPECT_FALSE(camera.is_taken({.attributes = {{"colour", {.tests = {{.value = "blue"}}}}}}));
}

TEST(ServiceFilters, AskThePredicateLast) {
  Camera camera("camera");
  FoundService seen;
  EXPECT_FALSE(camera.is_taken({.predicate = [&](const FoundService& found) {
    seen = found;
    return false;
  }}));
  EXPECT_EQ(seen.name, "counter");
  EXPECT_EQ(seen.node, camera.server.id());
  EXPECT_EQ(seen.node_name, "camera");
  EXPECT_EQ(seen.object_type, "test.counter.Counter");
  EXPECT_EQ(seen.implements.front(), "test.counter.Named");
  EXPECT_EQ(seen.attributes.at("size").number<std::int32_t>(), 5);
  EXPECT_TRUE(camera.is_taken({.predicate = [](const FoundService&) { return true; }}));
}

TEST(ServiceFilters, SayWhoLogsInWhere) {
  class Named : public Users {
   public:
    [[nodiscard]] User authenticate(const std::string& name,
                                    const std::map<std::string, VarValue>& /*credentials*/,
                                    const NodeId& /*node*/) const override {
      if (name != "carol") throw Error(ErrorCode::authentication_error, "Invalid credentials");
      return {name};
    }
  };
  Server server("counter", counter("a"), {.name = "safe"}, {.users = std::make_shared<Named>()});
  Node node;
  auto options = with(
      {.nodes = {{.name = "other", .username = "bob"}, {.name = "safe", .username = "carol"}}});
  options.username = "dave";
  auto subscription = node.subscribe(server.url() + "&nodename=safe", options);
  EXPECT_EQ(subscription.wait_default_client<CounterStub>(20s)->get_name(), "a");
  EXPECT_EQ(server.service()->clients().front().user, "carol");
}

TEST(ServiceFilters, LimitTheConnections) {
  Server first("counter", counter("first"));
  Server second("counter", counter("second"));
  const SilentPeer silent;
  Node node;
  auto options = with({.max_connections = 1});
  options.connect_timeout = slowness() * 3s;  // those that answer may need more than one
  std::atomic<int> silent_failures = 0;
  auto subscription = node.subscribe_all({{silent.url()}, {first.url()}, {second.url()}}, options);
  const auto counting =
      subscription.on_failed([&](const std::vector<std::string>& urls, const Error&) {
        if (urls.front() == silent.url()) ++silent_failures;
      });
  EXPECT_EQ(subscription.wait_default_client<CounterStub>(60s)->get_name(), "first");
  EXPECT_THAT(subscription.connected_clients(), SizeIs(1));
  EXPECT_THAT(second.service()->clients(), IsEmpty());
  std::this_thread::sleep_for(100ms);  // until the silent one waits again
  const int failures_before = silent_failures;
  first.stop();
  const auto is_second = [&] {
    const auto client = subscription.try_default_client<CounterStub>();
    return client &&
           error_of([&] { EXPECT_EQ(client->get_name(), "second"); }).code() == ErrorCode::none;
  };
  EXPECT_TRUE(eventually(is_second));
  EXPECT_EQ(silent_failures, failures_before) << "it is tried before one that has not failed";
}

// Attributes, without a service

bool matches(std::map<std::string, AttributeGroup> wanted, const VarValue& value,
             Match match = Match::all_of) {
  const subscription::Filter filter({.attributes = std::move(wanted), .attributes_match = match});
  FoundService service;
  if (!value.is_null()) service.attributes["a"] = value;
  return filter.refusal(service).empty();
}

bool matches(AttributeGroup group, const VarValue& value) {
  return matches({{"a", std::move(group)}}, value);
}

TEST(AttributeGroups, CombineTheirTests) {
  const VarValue both(std::string("x, y"));
  const VarValue one(std::string("x"));
  const std::vector<AttributeTest> tests = {{.value = "x"}, {.value = "y"}};
  EXPECT_TRUE(matches({.tests = tests, .match = Match::any_of}, one));
  EXPECT_FALSE(matches({.tests = tests, .match = Match::all_of}, one));
  EXPECT_TRUE(matches({.tests = tests, .match = Match::all_of}, both));
  EXPECT_FALSE(matches({.tests = tests, .match = Match::none_of}, one));
  EXPECT_TRUE(matches({.tests = tests, .match = Match::none_of}, VarValue(std::string("z"))));
  EXPECT_TRUE(matches({.tests = tests, .match = Match::none_of}, VarValue()));
  EXPECT_TRUE(matches({.tests = tests, .match = Match::not_all_of}, one));
  EXPECT_FALSE(matches({.tests = tests, .match = Match::not_all_of}, both));
  EXPECT_TRUE(matches({.match = Match::any_of}, one));
  EXPECT_TRUE(matches({.match = Match::all_of}, one));
  EXPECT_FALSE(matches({.match = Match::none_of}, one));
  EXPECT_FALSE(matches({.match = Match::not_all_of}, one));
  const AttributeGroup inner{.tests = {{.value = "x"}}};
  EXPECT_TRUE(matches({.groups = {inner}}, one));
  EXPECT_FALSE(
      matches({.tests = {{.value = "y"}}, .groups = {inner}, .match = Match::all_of}, one));
  const AttributeGroup other{.tests = {{.value = "z"}}};
  EXPECT_TRUE(matches({{"a", inner}, {"b", other}}, one, Match::any_of));
  EXPECT_FALSE(matches({{"a", inner}, {"b", other}}, one, Match::all_of));
}

TEST(AttributeGroups, LookAtTextsOfAllKinds) {
  const AttributeGroup x{.tests = {{.value = "x"}}};
  EXPECT_TRUE(matches(x, VarValue(VarList{std::string("w"), std::string("v, x")})));
  EXPECT_FALSE(matches({.tests = {{.value = "x"}}, .splits_at_commas = false},
                       VarValue(std::string("w,x"))));
  EXPECT_TRUE(matches({.tests = {{.value = "w,x"}}, .splits_at_commas = false},
                      VarValue(std::string("w,x"))));
  EXPECT_TRUE(matches({.tests = {{.value = ""}}}, VarValue(std::string("w,"))));
  EXPECT_FALSE(matches(x, VarValue(std::int32_t{5})));
  const VarValue map(VarStringMap{{"k", std::string("x")}, {"l", std::string("y")}});
  EXPECT_TRUE(matches(x, map));
  EXPECT_TRUE(matches({.tests = {{.value = "x", .name = "k"}}}, map));
  EXPECT_FALSE(matches({.tests = {{.value = "x", .name = "l"}}}, map));
  EXPECT_FALSE(matches({.tests = {{.value = "x", .name = "k"}}}, VarValue(std::string("x"))));
}

TEST(AttributeGroups, MatchRegularExpressions) {
  const AttributeGroup group{.tests = {{.value = "c[0-9]+", .is_expression = true}}};
  EXPECT_TRUE(matches(group, VarValue(std::string("b, c12"))));
  EXPECT_FALSE(matches(group, VarValue(std::string("c12b"))));
  EXPECT_FALSE(matches({.tests = {{.value = "(a|b)*", .is_expression = true}}},
                       VarValue(std::string(1'000'000, 'a'))));
  Node node;
  EXPECT_EQ(
      code_of([&] {
        node.subscribe(
            "rr+tcp://127.0.0.1:1/?service=a",
            with({.attributes = {{"a", {.tests = {{.value = "(", .is_expression = true}}}}}}));
      }),
      ErrorCode::invalid_argument);
}

}  // namespace
}  // namespace rr::testing
