// SPDX-License-Identifier: Apache-2.0
// Finding nodes and services through the C interface.
#include <algorithm>
#include <atomic>
#include <mutex>

#include "rr/codec.hpp"
#include "runtime/c/test/announced.hpp"

namespace rr::testing::c {
namespace {

using DiscoveryInC = Announced;

// What a program was told of nodes.
struct Told {
  std::mutex mutex;
  std::vector<std::string> detected;
  std::vector<std::string> lost;
  std::atomic<int> dropped = 0;

  [[nodiscard]] rr_discovery_handler handler() {
    rr_discovery_handler result{};
    result.size = sizeof result;
    result.context = this;
    result.on_detected = [](void* context, const rr_detected_node* node) {
      auto& told = *static_cast<Told*>(context);
      const std::lock_guard lock(told.mutex);
      told.detected.push_back(text(node->name));
    };
    result.on_lost = [](void* context, const rr_detected_node* node) {
      auto& told = *static_cast<Told*>(context);
      const std::lock_guard lock(told.mutex);
      told.lost.push_back(text(node->name));
    };
    result.drop = [](void* context) { ++static_cast<Told*>(context)->dropped; };
    return result;
  }
  std::size_t count(const std::vector<std::string>& of) {
    const std::lock_guard lock(mutex);
    return of.size();
  }
};

std::size_t known_nodes(const NodeHandle& node) {
  rr_detected_nodes* made = nullptr;
  EXPECT_EQ(rr_discovery_nodes(node.get(), &made, nullptr), RR_OK);
  const NodesHandle nodes(made);
  return rr_detected_nodes_count(made);
}

TEST_F(DiscoveryInC, TellsOfNodesThatComeAndGo) {
  Told told;
  const rr_discovery_handler handler = told.handler();
  rr_subscription* made = nullptr;
  ASSERT_EQ(rr_discovery_watch(node_.get(), &handler, &made, nullptr), RR_OK);
  SubscriptionHandle watching(made);
  const auto one = serve("one", "red");
  ASSERT_TRUE(eventually([&] { return told.count(told.detected) == 1; }));
  EXPECT_EQ(told.detected.at(0), "one");

  rr_detected_nodes* nodes_made = nullptr;
  ASSERT_EQ(rr_discovery_nodes(node_.get(), &nodes_made, nullptr), RR_OK);
  const NodesHandle nodes(nodes_made);
  ASSERT_EQ(rr_detected_nodes_count(nodes_made), 1U);
  const rr_detected_node node = read(nodes, 0);
  EXPECT_TRUE(std::equal(one->id().bytes.begin(), one->id().bytes.end(), node.id.bytes,
                         [](auto a, auto b) { return static_cast<std::uint8_t>(a) == b; }));
  ASSERT_EQ(node.url_count, 1U);
  EXPECT_NE(text(node.urls[0]).find("service=RobotRaconteurServiceIndex"), std::string::npos);

  // Who watches later is told of nodes that are there.
  Told later;
  const rr_discovery_handler second = later.handler();
  ASSERT_EQ(rr_discovery_watch(node_.get(), &second, &made, nullptr), RR_OK);
  const SubscriptionHandle watching_later(made);
  EXPECT_TRUE(eventually([&] { return later.count(later.detected) == 1; }));
  watching.reset();
  EXPECT_EQ(told.dropped, 1);

  EXPECT_EQ(rr_discovery_is_listening(node_.get()), 1);
  rr_discovery_stop_listening(node_.get());
  EXPECT_EQ(rr_discovery_is_listening(node_.get()), 0);
  EXPECT_TRUE(eventually([&] { return later.count(later.lost) == 1; }));
  EXPECT_EQ(told.count(told.lost), 0U);
  EXPECT_EQ(known_nodes(node_), 0U);
}

TEST_F(DiscoveryInC, ForgetsNodesThatAreNotHeardAnyMore) {
  listen(node_.get(), 1500);
  const NodeHandle other = make_node();
  rr::testing::c::listen(other);
  ASSERT_EQ(announce(other.get()), RR_OK);
  ASSERT_TRUE(eventually([&] { return known_nodes(node_) == 1; }));
  rr_discovery_stop_announcing(other.get());
  EXPECT_TRUE(eventually([&] { return known_nodes(node_) == 0; }));
}

TEST_F(DiscoveryInC, FindsServicesWithAllThatIsKnownOfThem) {
  const auto one = serve("one", "red");
  const rr_str types[] = {view("test.counter.Named"), view("some.Other")};
  const rr_find_options options = waiting(50);
  ServicesHandle services;
  ASSERT_TRUE(eventually([&] {
    rr_found_services* made = nullptr;
    EXPECT_EQ(rr_discovery_find_services(node_.get(), types, 2, &options, &made, nullptr), RR_OK);
    services.reset(made);
    return rr_found_services_count(made) == 1;
  }));
  const rr_found_service found = read(services, 0);
  EXPECT_EQ(text(found.name), "counter");
  EXPECT_EQ(text(found.node_name), "one");
  EXPECT_EQ(text(found.object_type), "test.counter.Counter");
  EXPECT_EQ(texts(found.implements, found.implement_count),
            std::vector<std::string>{"test.counter.Named"});
  ASSERT_EQ(found.url_count, 1U);
  EXPECT_NE(text(found.urls[0]).find("service=counter"), std::string::npos);
  VarStringMap attributes;
  decode_value({reinterpret_cast<const std::byte*>(found.attributes.data), found.attributes.size},
               type_of<VarStringMap>, &attributes, MessageVersion::v4, nullptr, {});
  EXPECT_EQ(attributes, (VarStringMap{{"color", "red"}}));

  rr_found_services* made = nullptr;
  ASSERT_EQ(rr_discovery_find_services(node_.get(), types, 1, nullptr, &made, nullptr), RR_OK);
  EXPECT_EQ(rr_found_services_count(made), 1U);
  rr_found_services_release(made);
  ASSERT_EQ(rr_discovery_find_services(node_.get(), types + 1, 1, nullptr, &made, nullptr), RR_OK);
  EXPECT_EQ(rr_found_services_count(made), 0U);
  rr_found_services_release(made);
  ASSERT_EQ(rr_discovery_find_services(node_.get(), nullptr, 0, nullptr, &made, nullptr), RR_OK);
  EXPECT_EQ(rr_found_services_count(made), 2U);  // the index, too
  rr_found_services_release(made);
  rr_find_options local = waiting(0);
  const rr_str schemes[] = {view("rr+local")};
  local.schemes = schemes;
  local.scheme_count = 1;
  ASSERT_EQ(rr_discovery_find_services(node_.get(), types, 2, &local, &made, nullptr), RR_OK);
  EXPECT_EQ(rr_found_services_count(made), 0U);
  rr_found_services_release(made);
}

TEST_F(DiscoveryInC, FindsNodesByIdAndName) {
  const auto one = serve("one", "red");
  const auto two = serve("two", "blue");
  ASSERT_TRUE(eventually([&] { return known_nodes(node_) == 2; }));
  rr_detected_nodes* made = nullptr;
  ASSERT_EQ(rr_discovery_find_nodes(node_.get(), view("two"), nullptr, &made, nullptr), RR_OK);
  const NodesHandle named(made);
  ASSERT_EQ(rr_detected_nodes_count(made), 1U);
  const rr_detected_node found = read(named, 0);
  EXPECT_EQ(text(found.name), "two");
  EXPECT_EQ(text(found.urls[0]).find("service="), std::string::npos);
  ASSERT_EQ(rr_discovery_find_node(node_.get(), found.id, nullptr, &made, nullptr), RR_OK);
  const NodesHandle by_id(made);
  ASSERT_EQ(rr_detected_nodes_count(made), 1U);
  EXPECT_EQ(text(read(by_id, 0).name), "two");
  ASSERT_EQ(rr_discovery_find_node(node_.get(), rr_node_id{}, nullptr, &made, nullptr), RR_OK);
  EXPECT_EQ(rr_detected_nodes_count(made), 0U);
  rr_detected_nodes_release(made);
  const rr_find_options options = waiting(1);
  ASSERT_EQ(rr_discovery_update_nodes(node_.get(), &options, &made, nullptr), RR_OK);
  EXPECT_EQ(rr_detected_nodes_count(made), 2U);
  rr_detected_nodes_release(made);
}

// A completion that is waited for.
struct Ended {
  std::mutex mutex;
  bool is_done = false;
  rr_status status = RR_OK;
  void* result = nullptr;
  Done done{[this](rr_status code, void* value) {
    const std::lock_guard lock(mutex);
    is_done = true;
    status = code;
    result = value;
  }};
  [[nodiscard]] bool comes() {
    return eventually([this] {
      const std::lock_guard lock(mutex);
      return is_done;
    });
  }
};

TEST_F(DiscoveryInC, FindsWithoutWaiting) {
  const auto one = serve("one", "red");
  ASSERT_TRUE(eventually([&] { return known_nodes(node_) == 1; }));
  const rr_str types[] = {view("test.counter.Counter")};
  Ended services, named, by_id, all;
  rr_completion done = services.done.completion();
  ASSERT_EQ(rr_discovery_find_services_async(node_.get(), types, 1, nullptr, &done, nullptr),
            RR_OK);
  ASSERT_TRUE(services.comes());
  const ServicesHandle found(static_cast<rr_found_services*>(services.result));
  ASSERT_EQ(rr_found_services_count(found.get()), 1U);
  done = named.done.completion();
  ASSERT_EQ(rr_discovery_find_nodes_async(node_.get(), view("one"), nullptr, &done, nullptr),
            RR_OK);
  ASSERT_TRUE(named.comes());
  const NodesHandle named_nodes(static_cast<rr_detected_nodes*>(named.result));
  ASSERT_EQ(rr_detected_nodes_count(named_nodes.get()), 1U);
  done = by_id.done.completion();
  ASSERT_EQ(rr_discovery_find_node_async(node_.get(), read(found, 0).node, nullptr, &done, nullptr),
            RR_OK);
  ASSERT_TRUE(by_id.comes());
  const NodesHandle one_node(static_cast<rr_detected_nodes*>(by_id.result));
  EXPECT_EQ(rr_detected_nodes_count(one_node.get()), 1U);
  done = all.done.completion();
  ASSERT_EQ(rr_discovery_update_nodes_async(node_.get(), nullptr, &done, nullptr), RR_OK);
  ASSERT_TRUE(all.comes());
  const NodesHandle all_nodes(static_cast<rr_detected_nodes*>(all.result));
  EXPECT_EQ(rr_detected_nodes_count(all_nodes.get()), 1U);
}

TEST_F(DiscoveryInC, CanBeCancelledWhileItWaits) {
  rr_cancellation* made = nullptr;
  ASSERT_EQ(rr_cancellation_new(&made, nullptr), RR_OK);
  const CancellationHandle cancellation(made);
  rr_find_options options = waiting(600'000);
  options.cancellation = made;
  Ended ended;
  const rr_completion done = ended.done.completion();
  ASSERT_EQ(rr_discovery_find_services_async(node_.get(), nullptr, 0, &options, &done, nullptr),
            RR_OK);
  rr_cancellation_cancel(made);
  ASSERT_TRUE(ended.comes());
  EXPECT_EQ(ended.status, RR_OPERATION_CANCELLED);
  EXPECT_EQ(ended.result, nullptr);
  rr_detected_nodes* nodes = nullptr;
  options.wait_ms = 0;
  EXPECT_EQ(rr_discovery_find_nodes(node_.get(), view("one"), &options, &nodes, nullptr),
            RR_OPERATION_CANCELLED);
  EXPECT_EQ(nodes, nullptr);
}

TEST_F(DiscoveryInC, EndsWithItsNode) {
  Told told;
  const rr_discovery_handler handler = told.handler();
  rr_subscription* made = nullptr;
  ASSERT_EQ(rr_discovery_watch(node_.get(), &handler, &made, nullptr), RR_OK);
  const SubscriptionHandle watching(made);
  const rr_find_options options = waiting(600'000);
  Ended ended;
  const rr_completion done = ended.done.completion();
  ASSERT_EQ(rr_discovery_update_nodes_async(node_.get(), &options, &done, nullptr), RR_OK);
  rr_node_shutdown(node_.get());
  ASSERT_TRUE(ended.comes());
  EXPECT_TRUE(ended.status == RR_OPERATION_CANCELLED || ended.status == RR_INVALID_OPERATION);
  EXPECT_EQ(told.dropped, 1);
  EXPECT_EQ(announce(node_.get()), RR_INVALID_OPERATION);
  EXPECT_EQ(rr_discovery_listen(node_.get(), nullptr, nullptr), RR_INVALID_OPERATION);
  rr_detected_nodes* nodes = nullptr;
  EXPECT_EQ(rr_discovery_find_nodes(node_.get(), view("one"), nullptr, &nodes, nullptr),
            RR_INVALID_OPERATION);
  EXPECT_EQ(rr_discovery_find_nodes_async(node_.get(), view("one"), nullptr, &done, nullptr),
            RR_INVALID_OPERATION);
}

TEST_F(DiscoveryInC, RefusesWhatIsWrong) {
  rr_announce_options announcing{};
  EXPECT_EQ(rr_discovery_announce(node_.get(), &announcing, nullptr), RR_INVALID_ARGUMENT);
  announcing.size = sizeof announcing;
  EXPECT_EQ(rr_discovery_announce(nullptr, &announcing, nullptr), RR_INVALID_ARGUMENT);
  announcing.networks = 16;
  EXPECT_EQ(rr_discovery_announce(node_.get(), &announcing, nullptr), RR_INVALID_ARGUMENT);
  rr_listen_options listening{};
  listening.size = sizeof listening;
  listening.port = 65'536;
  EXPECT_EQ(rr_discovery_listen(node_.get(), &listening, nullptr), RR_INVALID_ARGUMENT);
  listening.port = 0;
  listening.interface_count = 1;
  EXPECT_EQ(rr_discovery_listen(node_.get(), &listening, nullptr), RR_INVALID_ARGUMENT);
  EXPECT_EQ(rr_discovery_listen(nullptr, nullptr, nullptr), RR_INVALID_ARGUMENT);
  EXPECT_EQ(rr_discovery_is_listening(node_.get()), 1);  // as before
  EXPECT_EQ(rr_discovery_is_listening(nullptr), 0);
  rr_discovery_stop_listening(nullptr);
  rr_discovery_stop_announcing(nullptr);
  rr_discovery_stop_listening(node_.get());
  EXPECT_EQ(rr_discovery_request(node_.get(), nullptr), RR_INVALID_OPERATION);
  EXPECT_EQ(rr_discovery_request(nullptr, nullptr), RR_INVALID_ARGUMENT);
  listen(node_.get());
  EXPECT_EQ(rr_discovery_request(node_.get(), nullptr), RR_OK);

  Told told;
  const rr_discovery_handler handler = told.handler();
  rr_subscription* watching = nullptr;
  EXPECT_EQ(rr_discovery_watch(nullptr, &handler, &watching, nullptr), RR_INVALID_ARGUMENT);
  EXPECT_EQ(told.dropped, 1);
  EXPECT_EQ(rr_discovery_watch(node_.get(), &handler, nullptr, nullptr), RR_INVALID_ARGUMENT);
  EXPECT_EQ(told.dropped, 2);
  EXPECT_EQ(rr_discovery_watch(node_.get(), nullptr, &watching, nullptr), RR_INVALID_ARGUMENT);

  rr_detected_nodes* nodes = nullptr;
  EXPECT_EQ(rr_discovery_nodes(nullptr, &nodes, nullptr), RR_INVALID_ARGUMENT);
  EXPECT_EQ(rr_discovery_nodes(node_.get(), nullptr, nullptr), RR_INVALID_ARGUMENT);
  ASSERT_EQ(rr_discovery_nodes(node_.get(), &nodes, nullptr), RR_OK);
  const NodesHandle owner(nodes);
  rr_detected_node info{};
  EXPECT_EQ(rr_detected_nodes_read(nodes, 0, &info, nullptr), RR_INVALID_ARGUMENT);
  info.size = sizeof info;
  EXPECT_EQ(rr_detected_nodes_read(nodes, 0, &info, nullptr), RR_OUT_OF_RANGE);
  EXPECT_EQ(rr_detected_nodes_read(nullptr, 0, &info, nullptr), RR_INVALID_ARGUMENT);
  EXPECT_EQ(rr_detected_nodes_count(nullptr), 0U);
  rr_found_service service{};
  service.size = sizeof service;
  EXPECT_EQ(rr_found_services_read(nullptr, 0, &service, nullptr), RR_INVALID_ARGUMENT);
  EXPECT_EQ(rr_found_services_count(nullptr), 0U);
  rr_found_services* services = nullptr;
  EXPECT_EQ(rr_discovery_find_services(node_.get(), nullptr, 1, nullptr, &services, nullptr),
            RR_INVALID_ARGUMENT);
  rr_find_options options = waiting(0);
  options.scheme_count = 1;
  EXPECT_EQ(rr_discovery_find_services(node_.get(), nullptr, 0, &options, &services, nullptr),
            RR_INVALID_ARGUMENT);
  const rr_completion none{};
  EXPECT_EQ(rr_discovery_update_nodes_async(node_.get(), nullptr, &none, nullptr),
            RR_INVALID_ARGUMENT);
}

}  // namespace
}  // namespace rr::testing::c
