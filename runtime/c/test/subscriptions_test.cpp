// SPDX-License-Identifier: Apache-2.0
// Services that come and go, through the C interface.
#include <gtest/gtest.h>

#include "runtime/c/test/silent_service.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::testing::c {
namespace {

using SubscriptionOwner =
    std::unique_ptr<rr_service_subscription, Release<rr_service_subscription_release>>;
using WireOwner = std::unique_ptr<rr_wire_subscription, Release<rr_wire_subscription_release>>;
using ObjectOwner =
    std::unique_ptr<rr_object_subscription, Release<rr_object_subscription_release>>;
using PipeOwner = std::unique_ptr<rr_pipe_subscription, Release<rr_pipe_subscription_release>>;

struct State {
  std::atomic<int> connected = 0;
  std::atomic<int> disconnected = 0;
  std::atomic<int> failed = 0;
  std::atomic<int> dropped = 0;
  std::atomic<double> value = 0;
};

rr_subscribe_options options_for(State& state) {
  rr_subscribe_options options{};
  options.size = sizeof options;
  options.retry_delay_ms = 5;
  options.context = &state;
  options.on_connected = [](void* context, const rr_subscribed_client* client) {
    EXPECT_EQ(text(client->service), "silent");
    ++static_cast<State*>(context)->connected;
  };
  options.on_disconnected = [](void* context, const rr_subscribed_client*, const rr_error_info*) {
    ++static_cast<State*>(context)->disconnected;
  };
  options.on_failed = [](void* context, const rr_error_info* why) {
    EXPECT_NE(why->code, RR_OK);
    ++static_cast<State*>(context)->failed;
  };
  options.drop = [](void* context) { ++static_cast<State*>(context)->dropped; };
  return options;
}

SubscriptionOwner subscribe(const NodeHandle& node, std::uint16_t port, State& state) {
  const std::string url = "rr+tcp://127.0.0.1:" + std::to_string(port) + "/?service=silent";
  const rr_str urls[] = {view(url)};
  const rr_subscribe_options options = options_for(state);
  rr_service_subscription* made = nullptr;
  EXPECT_EQ(rr_service_subscribe(node.get(), urls, 1, &options, &made, nullptr), RR_OK);
  return SubscriptionOwner(made);
}

TEST(Subscriptions, BringTheObjectAndConnectAgain) {
  State state;
  SilentService silent;
  const NodeHandle node = make_node();
  SubscriptionOwner subscription = subscribe(node, silent.port, state);
  rr_object* made = nullptr;
  ASSERT_EQ(rr_service_subscription_root(subscription.get(), 20'000, &made, nullptr), RR_OK);
  const ObjectHandle root(made);
  EXPECT_EQ(text(rr_object_type_name(made)), "test.silent.Silent");
  EXPECT_TRUE(eventually([&] { return state.connected == 1; }));
  struct Listed {
    std::vector<std::uint32_t> clients;
  } listed;
  rr_service_clients(
      silent.service.get(), &listed,
      [](void* context, const rr_client_info* info) {
        static_cast<Listed*>(context)->clients.push_back(info->client);
      },
      nullptr);
  for (const std::uint32_t client : listed.clients) {
    rr_service_disconnect(silent.service.get(), client);
  }
  EXPECT_TRUE(eventually([&] { return state.disconnected == 1 && state.connected == 2; }));
  rr_service_subscription_close(subscription.get());
  EXPECT_EQ(rr_service_subscription_is_open(subscription.get()), 0);
  EXPECT_EQ(rr_service_subscription_root(subscription.get(), 10, &made, nullptr),
            RR_INVALID_OPERATION);
  subscription.reset();
  EXPECT_TRUE(eventually([&] { return state.dropped == 1; }));
}

TEST(Subscriptions, TellWhyThereIsNoClient) {
  State state;
  const NodeHandle node = make_node();
  const SubscriptionOwner subscription = subscribe(node, 1, state);
  rr_object* made = nullptr;
  EXPECT_TRUE(eventually([&] { return state.failed > 1; }));
  EXPECT_EQ(rr_service_subscription_root(subscription.get(), 0, &made, nullptr),
            RR_CONNECTION_ERROR);
  EXPECT_EQ(rr_service_subscription_root(subscription.get(), 5, &made, nullptr),
            RR_OPERATION_TIMEOUT);
  rr_service_subscription* none = nullptr;
  EXPECT_EQ(rr_service_subscribe(node.get(), nullptr, 0, nullptr, &none, nullptr),
            RR_INVALID_ARGUMENT);
}

TEST(Subscriptions, OfWiresAndPipesHaveValuesBothWays) {
  State state;
  SilentService silent;
  std::atomic<double> at_service = 0;
  rr_served_wire_handler served{};
  served.size = sizeof served;
  served.context = &at_service;
  served.on_value = [](void* context, std::uint32_t, const rr_elements* value, const rr_time*,
                       rr_data*) {
    *static_cast<std::atomic<double>*>(context) = unpack_double(value, nullptr);
  };
  ASSERT_EQ(rr_served_wire_set_handler(silent.object.get(), 3, &served, nullptr), RR_OK);
  const NodeHandle node = make_node();
  const SubscriptionOwner subscription = subscribe(node, silent.port, state);
  rr_wire_subscription* wire_made = nullptr;
  ASSERT_EQ(rr_wire_subscribe(subscription.get(), view("level"), view(""), &wire_made, nullptr),
            RR_OK);
  const WireOwner wire(wire_made);
  rr_pipe_subscription* pipe_made = nullptr;
  ASSERT_EQ(
      rr_pipe_subscribe(subscription.get(), view("numbers"), view("*"), 0, &pipe_made, nullptr),
      RR_OK);
  const PipeOwner pipe(pipe_made);
  Packed value;
  value.number("", 2.5);
  ASSERT_EQ(rr_served_wire_send(silent.object.get(), 3, &value, nullptr), RR_OK);
  EXPECT_EQ(rr_wire_subscription_wait(wire_made, 20'000), 1);
  rr_data* data = nullptr;
  ASSERT_EQ(rr_wire_subscription_received(wire_made, &data, nullptr, nullptr), RR_OK);
  rr_elements elements = rr_data_elements(data);
  EXPECT_EQ(unpack_double(&elements, nullptr), 2.5);
  rr_data_release(data);
  rr_wire_subscription_handler handler{};
  handler.size = sizeof handler;
  handler.context = &state;
  handler.on_value = [](void* context, const rr_subscribed_client*, const rr_elements* given,
                        const rr_time*, rr_data*) {
    static_cast<State*>(context)->value = unpack_double(given, nullptr);
  };
  ASSERT_EQ(rr_wire_subscription_set_handler(wire_made, &handler, nullptr), RR_OK);
  EXPECT_TRUE(eventually([&] { return state.value == 2.5; }));
  std::size_t count = 0;
  EXPECT_TRUE(eventually([&] {
    return rr_wire_subscription_send(wire_made, &value, &count, nullptr) == RR_OK && count == 1;
  }));
  EXPECT_TRUE(eventually([&] { return at_service == 2.5; }));

  std::size_t endpoints = 0;
  EXPECT_TRUE(eventually([&] {
    endpoints = 0;
    rr_served_pipe_endpoints(silent.object.get(), 2, nullptr, &endpoints, nullptr);
    return endpoints == 1;
  }));
  ASSERT_EQ(rr_served_pipe_send(silent.object.get(), 2, &value, nullptr), RR_OK);
  EXPECT_EQ(rr_pipe_subscription_wait(pipe_made, 20'000), 1);
  ASSERT_EQ(rr_pipe_subscription_receive(pipe_made, &data, nullptr), RR_OK);
  elements = rr_data_elements(data);
  EXPECT_EQ(unpack_double(&elements, nullptr), 2.5);
  rr_data_release(data);
  ASSERT_EQ(rr_pipe_subscription_receive(pipe_made, &data, nullptr), RR_OK);
  EXPECT_EQ(data, nullptr);
  EXPECT_TRUE(eventually([&] {
    return rr_pipe_subscription_send(pipe_made, &value, &count, nullptr) == RR_OK && count == 1;
  }));
  rr_pipe_subscription_close(pipe_made);
  rr_wire_subscription_close(wire_made);
}

TEST(Subscriptions, BringObjectsBelowTheRoot) {
  Pair pair;
  const std::string url = "rr+tcp://127.0.0.1:" + std::to_string(pair.port) + "/?service=counter";
  const rr_str urls[] = {view(url)};
  rr_service_subscription* made = nullptr;
  ASSERT_EQ(rr_service_subscribe(pair.node.get(), urls, 1, nullptr, &made, nullptr), RR_OK);
  const SubscriptionOwner subscription(made);
  rr_object_subscription* object_made = nullptr;
  ASSERT_EQ(rr_object_subscribe(made, view("*.by_name[low]"), &object_made, nullptr), RR_OK);
  const ObjectOwner object(object_made);
  rr_object* found = nullptr;
  rr_error* why = nullptr;
  const rr_status status = rr_object_subscription_get(object_made, 20'000, &found, &why);
  rr_error_info info{};
  info.size = sizeof info;
  if (why != nullptr) rr_error_read(why, &info);
  ASSERT_EQ(status, RR_OK) << text(info.message);
  const ObjectHandle child(found);
  EXPECT_EQ(text(rr_object_path(found)), "counter.by_name[low]");
  EXPECT_EQ(call(child, "value", nullptr, nullptr, RR_PROPERTY_GET).status, RR_OK);
  rr_object* again = nullptr;
  ASSERT_EQ(rr_object_subscription_get(object_made, 0, &again, nullptr), RR_OK);
  rr_object_release(again);

  rr_object_subscription* none_made = nullptr;
  ASSERT_EQ(rr_object_subscribe(made, view("*.nothing"), &none_made, nullptr), RR_OK);
  const ObjectOwner none(none_made);
  EXPECT_EQ(rr_object_subscription_get(none_made, 50, &again, nullptr), RR_OPERATION_TIMEOUT);
  EXPECT_EQ(rr_object_subscription_get(none_made, 0, &again, nullptr), RR_CONNECTION_ERROR);
  rr_object_subscription_close(object_made);
  EXPECT_EQ(rr_object_subscription_get(object_made, 10, &again, nullptr), RR_INVALID_OPERATION);
  EXPECT_EQ(rr_object_subscription_get(nullptr, 0, &again, nullptr), RR_INVALID_ARGUMENT);
}

}  // namespace
}  // namespace rr::testing::c
