// SPDX-License-Identifier: Apache-2.0
// Several services in one subscription, by URLs and by types, through the C interface.
#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstring>
#include <map>
#include <mutex>
#include <set>

#include "runtime/c/test/announced.hpp"
#include "runtime/c/test/silent_service.hpp"

namespace rr::testing::c {
namespace {

using SubscriptionOwner =
    std::unique_ptr<rr_service_subscription, Release<rr_service_subscription_release>>;
using WireOwner = std::unique_ptr<rr_wire_subscription, Release<rr_wire_subscription_release>>;
using PipeOwner = std::unique_ptr<rr_pipe_subscription, Release<rr_pipe_subscription_release>>;

using Id = std::array<std::uint8_t, 16>;

Id id_of(const rr_node_id& id) {
  Id result{};
  std::copy(std::begin(id.bytes), std::end(id.bytes), result.begin());
  return result;
}
Id id_of(const NodeHandle& node) { return id_of(rr_node_get_id(node.get())); }
Id id_of(const Node& node) {
  Id result{};
  std::memcpy(result.data(), node.id().bytes.data(), result.size());
  return result;
}

void add_client(void* context, const rr_subscribed_client* client) {
  static_cast<std::set<Id>*>(context)->insert(id_of(client->node));
}
std::set<Id> clients_of(const SubscriptionOwner& subscription) {
  std::set<Id> result;
  EXPECT_EQ(rr_service_subscription_clients(subscription.get(), &result, add_client, nullptr),
            RR_OK);
  return result;
}

std::string url_of(const SilentService& service) {
  return "rr+tcp://127.0.0.1:" + std::to_string(service.port) + "/?service=silent";
}

rr_subscribe_options quick() {
  rr_subscribe_options options{};
  options.size = sizeof options;
  options.retry_delay_ms = 5;
  return options;
}

// Two services in one subscription, the second by the URL that is tried after another.
struct Several {
  Several() {
    const rr_str first[] = {view(urls[0])};
    const rr_str second[] = {view(urls[2]), view(urls[1])};
    const rr_service_urls services[] = {{first, 1}, {second, 2}};
    const rr_subscribe_options options = quick();
    rr_service_subscription* made = nullptr;
    EXPECT_EQ(rr_service_subscribe_all(node.get(), services, 2, &options, &made, nullptr), RR_OK);
    subscription.reset(made);
  }

  SilentService one;
  SilentService two;
  const std::vector<std::string> urls{url_of(one), url_of(two),
                                      "rr+tcp://127.0.0.1:1/?service=silent"};
  const std::set<Id> both{id_of(one.server), id_of(two.server)};
  NodeHandle node = make_node();
  SubscriptionOwner subscription;
};

TEST(SeveralServices, AreClientsOfOneSubscription) {
  Several several;
  ASSERT_TRUE(eventually([&] { return clients_of(several.subscription) == several.both; }));
  const std::string name = "silent";
  rr_subscribed_client client{sizeof client, rr_node_get_id(several.two.server.get()), view(name)};
  rr_object* made = nullptr;
  ASSERT_EQ(
      rr_service_subscription_client_root(several.subscription.get(), &client, &made, nullptr),
      RR_OK);
  const ObjectHandle root(made);
  EXPECT_EQ(text(rr_object_type_name(made)), "test.silent.Silent");
  client.node = rr_node_get_id(several.node.get());
  EXPECT_EQ(
      rr_service_subscription_client_root(several.subscription.get(), &client, &made, nullptr),
      RR_CONNECTION_ERROR);
  EXPECT_EQ(made, nullptr);

  const rr_str left[] = {view(several.urls[1])};
  const rr_service_urls services[] = {{left, 1}};
  ASSERT_EQ(
      rr_service_subscription_update_services(several.subscription.get(), services, 1, nullptr),
      RR_OK);
  EXPECT_TRUE(eventually(
      [&] { return clients_of(several.subscription) == std::set<Id>{id_of(several.two.server)}; }));
}

// What a program was told of clients.
struct Told {
  std::mutex mutex;
  std::set<Id> connected;
  std::set<Id> disconnected;
  std::vector<std::string> failed;
  std::atomic<int> dropped = 0;

  [[nodiscard]] rr_service_subscription_handler handler() {
    rr_service_subscription_handler result{};
    result.size = sizeof result;
    result.context = this;
    result.on_connected = [](void* context, const rr_subscribed_client* client) {
      auto& told = *static_cast<Told*>(context);
      const std::lock_guard lock(told.mutex);
      told.connected.insert(id_of(client->node));
    };
    result.on_disconnected = [](void* context, const rr_subscribed_client* client,
                                const rr_error_info* why) {
      EXPECT_EQ(why->code, RR_OPERATION_ABORTED);
      auto& told = *static_cast<Told*>(context);
      const std::lock_guard lock(told.mutex);
      told.disconnected.insert(id_of(client->node));
    };
    result.on_failed = [](void* context, const rr_str* urls, std::size_t count,
                          const rr_error_info* why) {
      EXPECT_EQ(why->code, RR_CONNECTION_ERROR);
      auto& told = *static_cast<Told*>(context);
      const std::lock_guard lock(told.mutex);
      told.failed = texts(urls, count);
    };
    result.drop = [](void* context) { ++static_cast<Told*>(context)->dropped; };
    return result;
  }
  bool is(const std::set<Id>& set, const std::set<Id>& expected) {
    const std::lock_guard lock(mutex);
    return set == expected;
  }
};

TEST(SeveralServices, TellWhichClientComesAndGoes) {
  Several several;
  ASSERT_TRUE(eventually([&] { return clients_of(several.subscription) == several.both; }));
  Told told;
  const rr_service_subscription_handler handler = told.handler();
  rr_subscription* made = nullptr;
  ASSERT_EQ(rr_service_subscription_watch(several.subscription.get(), &handler, &made, nullptr),
            RR_OK);
  SubscriptionHandle watching(made);
  EXPECT_TRUE(eventually([&] { return told.is(told.connected, several.both); }));

  // The first one stays, and the one that is not there fails.
  const rr_str first[] = {view(several.urls[0])};
  const rr_str nothing[] = {view(several.urls[2])};
  const rr_service_urls services[] = {{first, 1}, {nothing, 1}};
  ASSERT_EQ(
      rr_service_subscription_update_services(several.subscription.get(), services, 2, nullptr),
      RR_OK);
  EXPECT_TRUE(eventually([&] { return told.is(told.disconnected, {id_of(several.two.server)}); }));
  EXPECT_TRUE(eventually([&] {
    const std::lock_guard lock(told.mutex);
    return told.failed == std::vector<std::string>{several.urls[2]};
  }));

  struct States {
    std::map<std::string, std::uint64_t> failures;
    std::map<std::string, Id> connected;
  } states;
  ASSERT_EQ(rr_service_subscription_services(
                several.subscription.get(), &states,
                [](void* context, const rr_subscribed_service* service) {
                  auto& seen = *static_cast<States*>(context);
                  ASSERT_EQ(service->url_count, 1U);
                  const std::string url = text(service->urls[0]);
                  if (service->client != nullptr) {
                    EXPECT_EQ(service->last_error, nullptr);
                    seen.connected[url] = id_of(service->client->node);
                  } else {
                    ASSERT_NE(service->last_error, nullptr);
                    EXPECT_EQ(service->last_error->code, RR_CONNECTION_ERROR);
                    seen.failures[url] = service->failures;
                  }
                },
                nullptr),
            RR_OK);
  EXPECT_EQ(states.connected,
            (std::map<std::string, Id>{{several.urls[0], id_of(several.one.server)}}));
  ASSERT_EQ(states.failures.size(), 1U);
  EXPECT_GE(states.failures[several.urls[2]], 1U);

  watching.reset();
  EXPECT_EQ(told.dropped, 1);
}

// The values that came from each client.
using Values = std::map<Id, double>;
void add_value(void* context, const rr_subscribed_client* client, const rr_elements* value,
               const rr_time* time, rr_data*) {
  EXPECT_GT(time->seconds, 0);
  (*static_cast<Values*>(context))[id_of(client->node)] = unpack_double(value, nullptr);
}

TEST(SeveralServices, SayWhichClientAValueIsOf) {
  Several several;
  rr_wire_subscription* made = nullptr;
  ASSERT_EQ(rr_wire_subscribe(several.subscription.get(), view("level"), view(""), &made, nullptr),
            RR_OK);
  const WireOwner wire(made);
  Values values;
  EXPECT_EQ(rr_wire_subscription_newest(made, &values, add_value, nullptr), RR_VALUE_NOT_SET);
  ASSERT_TRUE(eventually([&] {
    std::set<Id> clients;
    EXPECT_EQ(rr_wire_subscription_clients(made, &clients, add_client, nullptr), RR_OK);
    return clients == several.both;
  }));
  Packed first;
  first.number("", 1.5);
  ASSERT_EQ(rr_served_wire_send(several.one.object.get(), 3, &first, nullptr), RR_OK);
  ASSERT_EQ(rr_wire_subscription_wait(made, 20'000), 1);
  ASSERT_EQ(rr_wire_subscription_newest(made, &values, add_value, nullptr), RR_OK);
  EXPECT_EQ(values, (Values{{id_of(several.one.server), 1.5}}));
  Packed second;
  second.number("", 2.5);
  ASSERT_EQ(rr_served_wire_send(several.two.object.get(), 3, &second, nullptr), RR_OK);
  ASSERT_TRUE(eventually([&] {
    EXPECT_EQ(rr_wire_subscription_values(made, &values, add_value, nullptr), RR_OK);
    return values.size() == 2;
  }));
  EXPECT_EQ(values[id_of(several.two.server)], 2.5);
  std::size_t count = 0;
  ASSERT_EQ(rr_wire_subscription_send(made, &first, &count, nullptr), RR_OK);
  EXPECT_EQ(count, 2U);
  ASSERT_EQ(rr_wire_subscription_set_lifespan(made, 1, nullptr), RR_OK);
  EXPECT_TRUE(eventually([&] {
    return rr_wire_subscription_newest(made, &values, add_value, nullptr) == RR_VALUE_NOT_SET;
  }));
}

TEST(SeveralServices, SayWhichClientAPacketIsOf) {
  Several several;
  rr_pipe_subscription* made = nullptr;
  ASSERT_EQ(
      rr_pipe_subscribe(several.subscription.get(), view("numbers"), view("*"), 0, &made, nullptr),
      RR_OK);
  const PipeOwner pipe(made);
  ASSERT_TRUE(eventually([&] {
    std::set<Id> clients;
    EXPECT_EQ(rr_pipe_subscription_clients(made, &clients, add_client, nullptr), RR_OK);
    return clients == several.both;
  }));
  Values values;
  const auto take = [&] {
    return rr_pipe_subscription_take(
        made, &values,
        [](void* context, const rr_subscribed_client* client, const rr_elements* packet, rr_data*) {
          (*static_cast<Values*>(context))[id_of(client->node)] = unpack_double(packet, nullptr);
        },
        nullptr);
  };
  EXPECT_EQ(take(), RR_OK);
  EXPECT_TRUE(values.empty());
  Packed packet;
  packet.number("", 3.5);
  ASSERT_EQ(rr_served_pipe_send(several.two.object.get(), 2, &packet, nullptr), RR_OK);
  ASSERT_EQ(rr_pipe_subscription_wait(made, 20'000), 1);
  EXPECT_EQ(take(), RR_OK);
  EXPECT_EQ(values, (Values{{id_of(several.two.server), 3.5}}));
  std::size_t count = 0;
  ASSERT_EQ(rr_pipe_subscription_send(made, &packet, &count, nullptr), RR_OK);
  EXPECT_EQ(count, 2U);
}

TEST(SeveralServices, RefuseWhatIsWrong) {
  Several several;
  rr_service_subscription* made = nullptr;
  EXPECT_EQ(rr_service_subscribe_all(several.node.get(), nullptr, 1, nullptr, &made, nullptr),
            RR_INVALID_ARGUMENT);
  EXPECT_EQ(rr_service_subscribe_all(several.node.get(), nullptr, 0, nullptr, &made, nullptr),
            RR_INVALID_ARGUMENT);
  const rr_service_urls empty{nullptr, 0};
  EXPECT_EQ(rr_service_subscribe_all(several.node.get(), &empty, 1, nullptr, &made, nullptr),
            RR_INVALID_ARGUMENT);
  Told told;
  rr_subscribe_options options = quick();
  options.context = &told;
  options.drop = [](void* context) { ++static_cast<Told*>(context)->dropped; };
  EXPECT_EQ(rr_service_subscribe_types(nullptr, nullptr, 0, &options, &made, nullptr),
            RR_INVALID_ARGUMENT);
  EXPECT_EQ(told.dropped, 1);
  const rr_str none[] = {view(several.urls[2])};
  EXPECT_EQ(rr_service_subscribe(several.node.get(), none, 1, &options, nullptr, nullptr),
            RR_INVALID_ARGUMENT);
  EXPECT_EQ(told.dropped, 2);
  const rr_service_subscription_handler handler = told.handler();
  rr_subscription* watching = nullptr;
  EXPECT_EQ(rr_service_subscription_watch(nullptr, &handler, &watching, nullptr),
            RR_INVALID_ARGUMENT);
  EXPECT_EQ(told.dropped, 3);
  rr_service_subscription* const of = several.subscription.get();
  EXPECT_EQ(rr_service_subscription_clients(of, nullptr, nullptr, nullptr), RR_INVALID_ARGUMENT);
  EXPECT_EQ(rr_service_subscription_services(of, nullptr, nullptr, nullptr), RR_INVALID_ARGUMENT);
  rr_object* root = nullptr;
  EXPECT_EQ(rr_service_subscription_client_root(of, nullptr, &root, nullptr), RR_INVALID_ARGUMENT);
  const rr_subscribed_client without_size{};
  EXPECT_EQ(rr_service_subscription_client_root(of, &without_size, &root, nullptr),
            RR_INVALID_ARGUMENT);
  EXPECT_EQ(rr_service_subscription_update_services(of, nullptr, 1, nullptr), RR_INVALID_ARGUMENT);
  EXPECT_EQ(rr_service_subscription_update_types(of, nullptr, 0, nullptr, nullptr),
            RR_INVALID_OPERATION);  // it is of URLs
  EXPECT_EQ(rr_wire_subscription_newest(nullptr, nullptr, add_value, nullptr), RR_INVALID_ARGUMENT);
  EXPECT_EQ(rr_wire_subscription_values(nullptr, nullptr, add_value, nullptr), RR_INVALID_ARGUMENT);
  EXPECT_EQ(rr_wire_subscription_clients(nullptr, nullptr, add_client, nullptr),
            RR_INVALID_ARGUMENT);
  EXPECT_EQ(rr_wire_subscription_set_lifespan(nullptr, 1, nullptr), RR_INVALID_ARGUMENT);
  EXPECT_EQ(rr_pipe_subscription_take(nullptr, nullptr, nullptr, nullptr), RR_INVALID_ARGUMENT);
  EXPECT_EQ(rr_pipe_subscription_clients(nullptr, nullptr, add_client, nullptr),
            RR_INVALID_ARGUMENT);
  rr_service_subscription_close(of);
  const rr_str urls[] = {view(several.urls[0])};
  const rr_service_urls services[] = {{urls, 1}};
  EXPECT_EQ(rr_service_subscription_update_services(of, services, 1, nullptr),
            RR_INVALID_OPERATION);
}

// As a program has it that was compiled with minor version 2.
TEST(SeveralServices, TakeOptionsWithoutAFilter) {
  SilentService one;
  const NodeHandle node = make_node();
  rr_subscribe_options options = quick();
  options.size = offsetof(rr_subscribe_options, filter);
  std::memset(static_cast<void*>(&options.filter), 0xEE, sizeof(const rr_service_filter*));
  const std::string url = url_of(one);
  const rr_str urls[] = {view(url)};
  rr_service_subscription* made = nullptr;
  ASSERT_EQ(rr_service_subscribe(node.get(), urls, 1, &options, &made, nullptr), RR_OK);
  const SubscriptionOwner subscription(made);
  EXPECT_TRUE(
      eventually([&] { return clients_of(subscription) == std::set<Id>{id_of(one.server)}; }));
}

class ServicesOfTypes : public Announced {
 protected:
  SubscriptionOwner subscribe(const rr_service_filter* filter) {
    const rr_str types[] = {view("some.Other"), view("test.counter.Counter")};
    rr_subscribe_options options = quick();
    options.filter = filter;
    rr_service_subscription* made = nullptr;
    EXPECT_EQ(rr_service_subscribe_types(node_.get(), types, 2, &options, &made, nullptr), RR_OK);
    return SubscriptionOwner(made);
  }
  static bool is_only(const SubscriptionOwner& subscription, const Node& node) {
    return clients_of(subscription) == std::set<Id>{id_of(node)};
  }
};

rr_service_filter make_filter() {
  rr_service_filter filter{};
  filter.size = sizeof filter;
  return filter;
}

TEST_F(ServicesOfTypes, AreConnectedAsTheyComeAndGo) {
  const SubscriptionOwner counters = subscribe(nullptr);
  auto one = serve("one", "red");
  ASSERT_TRUE(eventually([&] { return is_only(counters, *one); }));
  const auto two = serve("two", "blue");
  ASSERT_TRUE(eventually([&] { return clients_of(counters).size() == 2; }));
  one.reset();
  ASSERT_TRUE(eventually([&] { return is_only(counters, *two); }));
  rr_object* made = nullptr;
  ASSERT_EQ(rr_service_subscription_root(counters.get(), 0, &made, nullptr), RR_OK);
  const ObjectHandle root(made);
  const Outcome name = call(root, "name", nullptr, nullptr, RR_PROPERTY_GET);
  EXPECT_EQ(name.status, RR_OK) << name.message;
}

TEST_F(ServicesOfTypes, PassAFilterThatMayBeExchanged) {
  const auto red = serve("one", "red");
  const auto blue = serve("two", "blue");
  const rr_attribute_test is_red[] = {{view("red|green"), {}, 1, 0}};
  rr_attribute_group color{};
  color.attribute = view("color");
  color.tests = is_red;
  color.test_count = 1;
  rr_service_filter filter = make_filter();
  filter.attributes = &color;
  filter.attribute_count = 1;
  const SubscriptionOwner counters = subscribe(&filter);
  ASSERT_TRUE(eventually([&] { return is_only(counters, *red); }));

  // Not red, in a group of the group.
  const rr_str types[] = {view("test.counter.Counter")};
  rr_attribute_group inner{};
  inner.tests = is_red;
  inner.test_count = 1;
  inner.match = RR_MATCH_NONE;
  color.tests = nullptr;
  color.test_count = 0;
  color.groups = &inner;
  color.group_count = 1;
  ASSERT_EQ(rr_service_subscription_update_types(counters.get(), types, 1, &filter, nullptr),
            RR_OK);
  ASSERT_TRUE(eventually([&] { return is_only(counters, *blue); }));

  rr_node_filter nodes[1] = {};
  nodes[0].name = view("one");
  const rr_str names[] = {view("counter")};
  const rr_str schemes[] = {view("rr+tcp")};
  rr_service_filter by_node = make_filter();
  by_node.nodes = nodes;
  by_node.node_count = 1;
  by_node.service_names = names;
  by_node.service_name_count = 1;
  by_node.transport_schemes = schemes;
  by_node.transport_scheme_count = 1;
  ASSERT_EQ(rr_service_subscription_update_types(counters.get(), types, 1, &by_node, nullptr),
            RR_OK);
  ASSERT_TRUE(eventually([&] { return is_only(counters, *red); }));
  nodes[0].name = {};
  std::memcpy(nodes[0].id.bytes, blue->id().bytes.data(), sizeof nodes[0].id.bytes);
  ASSERT_EQ(rr_service_subscription_update_types(counters.get(), types, 1, &by_node, nullptr),
            RR_OK);
  ASSERT_TRUE(eventually([&] { return is_only(counters, *blue); }));
}

TEST_F(ServicesOfTypes, AreAskedAboutByAPredicate) {
  struct Asked {
    std::atomic<int> asked = 0;
    std::atomic<int> dropped = 0;
  } asked;
  rr_service_filter filter = make_filter();
  filter.max_connections = 5;
  filter.context = &asked;
  filter.predicate = [](void* context, const rr_found_service* service) {
    ++static_cast<Asked*>(context)->asked;
    EXPECT_EQ(text(service->object_type), "test.counter.Counter");
    EXPECT_EQ(service->attributes.count, 1U);
    return text(service->node_name) == "two" ? 1 : 0;
  };
  filter.drop = [](void* context) { ++static_cast<Asked*>(context)->dropped; };
  SubscriptionOwner counters = subscribe(&filter);
  const auto one = serve("one", "red");
  const auto two = serve("two", "blue");
  ASSERT_TRUE(eventually([&] { return is_only(counters, *two) && asked.asked >= 2; }));
  EXPECT_EQ(asked.dropped, 0);
  rr_service_subscription_close(counters.get());
  counters.reset();
  node_.reset();
  EXPECT_EQ(asked.dropped, 1);
}

TEST_F(ServicesOfTypes, RefuseWrongFilters) {
  std::atomic<int> dropped = 0;
  rr_service_filter filter = make_filter();
  filter.context = &dropped;
  filter.drop = [](void* context) { ++*static_cast<std::atomic<int>*>(context); };
  const auto refused = [&](rr_status status) {
    const int before = dropped;
    rr_subscribe_options options = quick();
    options.filter = &filter;
    rr_service_subscription* made = nullptr;
    EXPECT_EQ(rr_service_subscribe_types(node_.get(), nullptr, 0, &options, &made, nullptr),
              status);
    EXPECT_EQ(made, nullptr);
    rr_service_info_subscription* infos = nullptr;
    EXPECT_EQ(rr_service_info_subscribe(node_.get(), nullptr, 0, &filter, nullptr, &infos, nullptr),
              status);
    EXPECT_EQ(infos, nullptr);
    EXPECT_EQ(dropped, before + 2);
  };
  filter.node_count = 1;
  refused(RR_INVALID_ARGUMENT);
  filter.node_count = 0;
  filter.service_name_count = 1;
  refused(RR_INVALID_ARGUMENT);
  filter.service_name_count = 0;
  filter.attributes_match = 9;
  refused(RR_INVALID_ARGUMENT);
  filter.attributes_match = 0;
  rr_attribute_group groups[2] = {};
  filter.attributes = groups;
  filter.attribute_count = 1;
  refused(RR_INVALID_ARGUMENT);  // without a name
  groups[0].attribute = view("color");
  groups[1].attribute = view("color");
  filter.attribute_count = 2;
  refused(RR_INVALID_ARGUMENT);  // twice
  filter.attribute_count = 1;
  groups[0].groups = groups;  // itself
  groups[0].group_count = 1;
  refused(RR_INVALID_ARGUMENT);
  groups[0].group_count = 0;
  groups[0].test_count = 1;
  refused(RR_INVALID_ARGUMENT);
  const rr_attribute_test wrong[] = {{view("("), {}, 1, 0}};
  groups[0].tests = wrong;
  refused(RR_INVALID_ARGUMENT);
  filter.size = 1;
  rr_service_info_subscription* infos = nullptr;
  EXPECT_EQ(rr_service_info_subscribe(node_.get(), nullptr, 0, &filter, nullptr, &infos, nullptr),
            RR_INVALID_ARGUMENT);
}

}  // namespace
}  // namespace rr::testing::c
