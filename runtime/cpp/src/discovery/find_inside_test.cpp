// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "rr/discovery.hpp"
#include "rr/node.hpp"
#include "rr/url.hpp"
#include "runtime/cpp/src/channel/interruption.hpp"
#include "runtime/cpp/src/discovery/testing.hpp"
#include "runtime/cpp/src/endpoint/service_index_types.hpp"
#include "runtime/cpp/src/node/testing/counter.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/process_state.hpp"

namespace rr::discovery {
namespace {

using namespace std::chrono_literals;
using rr::testing::Counter;
using rr::testing::CounterStub;
using rr::testing::error_of;
using rr::testing::eventually;

/// A node with a counter that announces itself.
struct Announced {
  explicit Announced(const DiscoveryNetwork& network, std::string name = "counter.node",
                     std::chrono::milliseconds period = 55s)
      : node({.name = std::move(name)}) {
    service = node.register_service("counter", std::make_shared<Counter>(),
                                    {.attributes = {{"color", "red"}}});
    node.listen_tcp(0, "*");
    node.discovery().announce({.network = network, .period = period});
  }
  Node node;
  Service service;
};

class Finding : public ::testing::Test {
 protected:
  DiscoveryNetwork network_ = loopback_network();
  Node finder_;
};

TEST_F(Finding, NothingRunsUntilItIsAskedFor) {
  const std::size_t before = rr::testing::ProcessState::now().threads;
  Node node;
  EXPECT_TRUE(node.discovery().detected_nodes().empty());
  EXPECT_FALSE(node.discovery().is_listening());
  EXPECT_EQ(rr::testing::ProcessState::now().threads, before);
}

TEST_F(Finding, ANodeThatAnnouncesItselfIsDetected) {
  Announced other(network_);
  std::atomic<int> found = 0;
  const Discovery discovery = finder_.discovery();
  const auto told = discovery.on_detected([&](const DetectedNode& node) {
    if (node.id == other.node.id()) ++found;
  });
  discovery.listen(listening_at(network_));
  ASSERT_TRUE(eventually([&] { return found == 1; }));
  const auto nodes = discovery.detected_nodes();
  ASSERT_EQ(nodes.size(), 1U);
  EXPECT_EQ(nodes[0].name, "counter.node");
  ASSERT_EQ(nodes[0].urls.size(), 1U);
  const Url url = Url::parse(nodes[0].urls[0]);
  EXPECT_EQ(url.host, "127.0.0.1");
  EXPECT_EQ(url.service, "RobotRaconteurServiceIndex");
  EXPECT_EQ(url.node_id, other.node.id());
}

TEST(ServiceUrls, HaveAPathAlsoWhereTheHostIsEmpty) {
  const NodeId id = *NodeId::parse("5f3a1c20-8d64-4b1e-9a77-0c2d4e6f8a01");
  const std::string rest = "/?nodeid=5f3a1c20-8d64-4b1e-9a77-0c2d4e6f8a01&service=lamp";
  for (const std::string base :
       {"rr+local://", "rr+intra://", "rr+local://alice@localhost", "rr+tcp://127.0.0.1:6000"}) {
    EXPECT_EQ(service_index::service_url(base, id, "lamp"), base + rest);
    EXPECT_EQ(service_index::service_url(base + "/", id, "lamp"), base + rest);
  }
  EXPECT_EQ(service_index::service_url("rr+local:///run/own.sock", id, "lamp"),
            "rr+local:///run/own.sock" + rest.substr(1));
}

TEST_F(Finding, ANodeAnswersRequestsWhileItListens) {
  // Announced once before anybody listens, it is heard again only because it was asked.
  Announced other(network_);
  other.node.discovery().listen(listening_at(network_));
  std::this_thread::sleep_for(700ms);
  const auto begin = std::chrono::steady_clock::now();
  finder_.discovery().listen(listening_at(network_));
  ASSERT_TRUE(eventually([&] { return finder_.discovery().detected_nodes().size() == 1; }));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 500ms);
}

TEST_F(Finding, ServicesAreFoundByTypeWithAllTheirUrls) {
  Announced other(network_);
  finder_.discovery().listen(listening_at(network_));
  ASSERT_TRUE(eventually([&] { return finder_.discovery().detected_nodes().size() == 1; }));
  for (const char* const type : {"test.counter.Counter", "test.counter.Named"}) {
    const auto services = finder_.discovery().find_services(type);
    ASSERT_EQ(services.size(), 1U) << type;
    EXPECT_EQ(services[0].name, "counter");
    EXPECT_EQ(services[0].node, other.node.id());
    EXPECT_EQ(services[0].node_name, "counter.node");
    EXPECT_EQ(services[0].object_type, "test.counter.Counter");
    EXPECT_EQ(services[0].implements, std::vector<std::string>{"test.counter.Named"});
    EXPECT_EQ(services[0].attributes.at("color").get<std::string>(), "red");
    ASSERT_EQ(services[0].urls.size(), 1U);
    EXPECT_EQ(finder_.connect<CounterStub>(services[0].urls[0])->add(1, 2), 3);
  }
  EXPECT_TRUE(finder_.discovery().find_services("test.counter.Other").empty());
  EXPECT_TRUE(
      finder_.discovery().find_services("test.counter.Counter", {.schemes = {"rrs+tcp"}}).empty());
  const auto all = finder_.discovery().all_services();
  ASSERT_EQ(all.size(), 2U);
}

TEST_F(Finding, EveryUrlOfANodeIsACandidate) {
  Announced other(network_);
  const std::uint16_t second = other.node.listen_tcp(0, "127.0.0.1");
  finder_.discovery().listen(listening_at(network_));
  ASSERT_TRUE(eventually([&] {
    const auto nodes = finder_.discovery().detected_nodes();
    return nodes.size() == 1 && nodes[0].urls.size() == 2;
  }));
  const auto services = finder_.discovery().find_services("test.counter.Counter");
  ASSERT_EQ(services.size(), 1U);
  ASSERT_EQ(services[0].urls.size(), 2U);
  bool has_second = false;
  for (const std::string& url : services[0].urls) {
    has_second = has_second || Url::parse(url).port == second;
    EXPECT_EQ(finder_.connect<CounterStub>(url)->get_fixed(), 42.125);
  }
  EXPECT_TRUE(has_second);
}

TEST_F(Finding, NodesAreFoundByIdAndByName) {
  Announced one(network_, "one");
  Announced two(network_, "two");
  finder_.discovery().listen(listening_at(network_));
  ASSERT_TRUE(eventually([&] { return finder_.discovery().detected_nodes().size() == 2; }));
  const auto by_id = finder_.discovery().find_node(two.node.id());
  ASSERT_EQ(by_id.size(), 1U);
  EXPECT_EQ(by_id[0].name, "two");
  EXPECT_TRUE(Url::parse(by_id[0].urls.at(0)).service.empty());
  const auto by_name = finder_.discovery().async_find_nodes("one").get();
  ASSERT_EQ(by_name.size(), 1U);
  EXPECT_EQ(by_name[0].id, one.node.id());
  EXPECT_TRUE(finder_.discovery().find_nodes("three").empty());
}

TEST_F(Finding, ChangedServicesAreAskedForAnew) {
  Announced other(network_, "counter.node", 500ms);
  const auto infos = [&] {
    finder_.discovery().listen(listening_at(network_));
    return finder_.subscribe_services({"test.counter.Counter"});
  }();
  std::mutex mutex;
  std::multiset<std::string> came;
  std::multiset<std::string> left;
  std::string color;
  const auto detected = infos.on_detected([&](const FoundService& service) {
    const std::lock_guard lock(mutex);
    came.insert(service.name);
  });
  const auto changed = infos.on_changed([&](const FoundService& service) {
    const std::lock_guard lock(mutex);
    color = service.attributes.at("color").get<std::string>();
  });
  const auto lost = infos.on_lost([&](const FoundService& service) {
    const std::lock_guard lock(mutex);
    left.insert(service.name);
  });
  const auto has = [&](const std::multiset<std::string>& names, const std::string& name) {
    const std::lock_guard lock(mutex);
    return names.count(name) == 1;
  };
  ASSERT_TRUE(eventually([&] { return has(came, "counter"); }));
  Service second = other.node.register_service("second", std::make_shared<Counter>());
  ASSERT_TRUE(eventually([&] { return has(came, "second"); }));
  EXPECT_EQ(infos.services().size(), 2U);
  second->close();
  ASSERT_TRUE(eventually([&] { return has(left, "second"); }));
  other.service->set_attributes({{"color", "blue"}});
  ASSERT_TRUE(eventually([&] {
    const std::lock_guard lock(mutex);
    return color == "blue";
  }));
  EXPECT_EQ(infos.services().size(), 1U);
}

TEST_F(Finding, ANodeThatIsSilentIsLost) {
  auto other = std::make_unique<Announced>(network_, "counter.node", 500ms);
  const NodeId id = other->node.id();
  ListenOptions options = listening_at(network_);
  options.lifetime = 1500ms;
  std::atomic<int> lost = 0;
  const auto told = finder_.discovery().on_lost([&](const DetectedNode& node) {
    if (node.id == id) ++lost;
  });
  finder_.discovery().listen(options);
  const auto infos = finder_.subscribe_services({"test.counter.Counter"});
  ASSERT_TRUE(eventually([&] { return infos.services().size() == 1; }));
  std::this_thread::sleep_for(2s);  // longer than one announcement is good for
  EXPECT_EQ(lost, 0);
  other.reset();
  ASSERT_TRUE(eventually([&] { return lost == 1; }));
  EXPECT_TRUE(eventually([&] { return infos.services().empty(); }));
  EXPECT_TRUE(finder_.discovery().detected_nodes().empty());
}

TEST_F(Finding, TheIndexOfANodeTellsWhomItHasDetected) {
  Announced other(network_, "other", 500ms);
  Node asked;
  const std::uint16_t port = asked.listen_tcp(0, "127.0.0.1");
  asked.discovery().listen(listening_at(network_));
  ASSERT_TRUE(eventually([&] { return asked.discovery().detected_nodes().size() == 1; }));
  const auto index = finder_.connect<service_index::IndexStub>(
      "rr+tcp://127.0.0.1:" + std::to_string(port) + "/?service=RobotRaconteurServiceIndex");
  const auto nodes = index->get_detected_nodes();
  ASSERT_TRUE(nodes);
  ASSERT_EQ(nodes->size(), 1U);
  const auto& node = *nodes->at(0);
  EXPECT_EQ(node.NodeName, "other");
  EXPECT_EQ(node.NodeID, other.node.id().bytes);
  EXPECT_EQ(node.ServiceIndexConnectionURL->at(1),
            asked.discovery().detected_nodes().at(0).urls.at(0));
}

TEST_F(Finding, TheIndexListsAttributesThatAreNumbersAndStrings) {
  Node asked;
  const std::uint16_t port = asked.listen_tcp(0, "127.0.0.1");
  asked.register_service("counter", std::make_shared<Counter>(),
                         {.attributes = {{"location", "here"},
                                         {"channels", Array<std::int32_t>{1, 2, 3}},
                                         {"list", VarList{VarValue("x")}}}});
  const auto index = finder_.connect<service_index::IndexStub>(
      "rr+tcp://127.0.0.1:" + std::to_string(port) + "/?service=RobotRaconteurServiceIndex");
  std::atomic<int> changes = 0;
  const auto changed = index->services_changed().connect([&] { ++changes; });
  const auto services = index->get_local_node_services();
  ASSERT_TRUE(services);
  ASSERT_EQ(services->size(), 2U);
  EXPECT_EQ(services->at(0)->Name, "counter");
  EXPECT_EQ(services->at(1)->Name, "RobotRaconteurServiceIndex");
  const auto& attributes = *services->at(0)->Attributes;
  EXPECT_EQ(attributes.size(), 2U);
  EXPECT_EQ(attributes.at("location").get<std::string>(), "here");
  EXPECT_EQ(attributes.at("channels").get<Array<std::int32_t>>().size(), 3U);
  asked.register_service("second", std::make_shared<Counter>());
  EXPECT_TRUE(eventually([&] { return changes == 1; }));
}

TEST_F(Finding, WaitsCanBeInterrupted) {
  channel::Interruption interruption;
  finder_.discovery().listen(listening_at(network_));
  std::thread waker([&] {
    std::this_thread::sleep_for(50ms);
    interruption.interrupt();
  });
  const auto begin = std::chrono::steady_clock::now();
  const Error error = error_of([&] {
    const channel::Interruption::Scope scope(interruption);
    (void)finder_.discovery().find_services("any.Type", {.wait = 60s});
  });
  waker.join();
  EXPECT_EQ(error.code(), ErrorCode::operation_cancelled);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 10s);
}

TEST_F(Finding, TheEndOfTheNodeEndsWaits) {
  auto node = std::make_unique<Node>();
  node->discovery().listen(listening_at(network_));
  auto waiting = node->discovery().async_find_services("any.Type", {.wait = 60s});
  std::this_thread::sleep_for(20ms);
  const Discovery discovery = node->discovery();
  node.reset();
  const ErrorCode code = error_of([&] { (void)waiting.get(); }).code();
  // On a busy machine the wait has not begun.
  EXPECT_TRUE(code == ErrorCode::operation_cancelled || code == ErrorCode::invalid_operation)
      << static_cast<int>(code);
  EXPECT_EQ(error_of([&] { discovery.listen(); }).code(), ErrorCode::invalid_operation);
  EXPECT_TRUE(discovery.detected_nodes().empty());
}

TEST_F(Finding, OnlyANodeThatListensMayAsk) {
  EXPECT_EQ(error_of([&] { finder_.discovery().request(); }).code(), ErrorCode::invalid_operation);
  finder_.discovery().listen(listening_at(network_));
  finder_.discovery().request();
  finder_.discovery().stop_listening();
  EXPECT_FALSE(finder_.discovery().is_listening());
}

TEST(CandidateUrls, NameEveryAddressOfThisMachine) {
  Node node;
  const std::uint16_t port = node.listen_tcp(0, "*");
  const auto urls = node.candidate_urls("counter");
  const std::string loopback = "rr+tcp://127.0.0.1:" + std::to_string(port) +
                               "/?nodeid=" + node.id().text() + "&service=counter";
  EXPECT_NE(std::find(urls.begin(), urls.end(), loopback), urls.end());
  for (const std::string& url : urls) EXPECT_EQ(url.find('%'), std::string::npos) << url;
}

}  // namespace
}  // namespace rr::discovery
