// SPDX-License-Identifier: Apache-2.0
// What a client says to those whom discovery has found: anybody can have announced himself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "rr/authority.hpp"
#include "rr/discovery.hpp"
#include "rr/node.hpp"
#include "rr/users.hpp"
#include "runtime/cpp/src/discovery/testing.hpp"
#include "runtime/cpp/src/node/testing/counter.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::discovery {
namespace {

using namespace std::chrono_literals;
using rr::testing::Counter;
using rr::testing::CounterStub;
using rr::testing::error_of;
using rr::testing::eventually;
using ::testing::HasSubstr;

/// Lets everybody in, and keeps what they say.
class Listening final : public Users {
 public:
  [[nodiscard]] User authenticate(const std::string& name,
                                  const std::map<std::string, VarValue>& /*credentials*/,
                                  const NodeId& /*node*/) const override {
    const std::lock_guard lock(mutex_);
    names_.push_back(name);
    return {name};
  }
  [[nodiscard]] std::vector<std::string> names() const {
    const std::lock_guard lock(mutex_);
    return names_;
  }

 private:
  mutable std::mutex mutex_;
  mutable std::vector<std::string> names_;
};

class FoundServices : public ::testing::Test {
 protected:
  FoundServices() { serve(attacker_, NodeOptions{.name = "attacker"}); }
  void serve(std::unique_ptr<Node>& node, NodeOptions options) {
    node = std::make_unique<Node>(std::move(options));
    node->register_service("counter", std::make_shared<Counter>("found"), {.users = users_});
    // Where clients may connect without a user, and log in later.
    node->register_service("open", std::make_shared<Counter>("found"),
                           {.users = users_, .require_user = false});
    port_ = node->listen_tcp(0, "127.0.0.1");
    node->discovery().announce({.network = network_, .period = 200ms});
  }
  static SubscriptionOptions as_alice() {
    return {.username = "alice", .credentials = {{"password", "secret"}}, .retry_delay = 50ms};
  }
  static ConnectOptions alice() {
    return {.username = "alice", .credentials = {{"password", "secret"}}};
  }
  /// Its URL, once discovery knows it.
  std::string found_url(Node& client) const {
    client.discovery().listen(listening_at(network_));
    std::string url;
    EXPECT_TRUE(eventually([&] {
      const auto services =
          client.discovery().find_services("test.counter.Counter", {.wait = 100ms});
      if (!services.empty()) url = services[0].urls.at(0);
      return !services.empty();
    }));
    return url;
  }

  DiscoveryNetwork network_ = loopback_network();
  std::shared_ptr<Listening> users_ = std::make_shared<Listening>();
  std::unique_ptr<Node> attacker_;
  std::uint16_t port_ = 0;
};

TEST_F(FoundServices, GetNoCredentialsInClearFromASubscription) {
  Node client;
  client.discovery().listen(listening_at(network_));
  ServiceSubscription counters = client.subscribe_type("test.counter.Counter", as_alice());
  ASSERT_TRUE(eventually([&] { return counters.last_error().has_value(); }));
  EXPECT_EQ(counters.last_error()->code(), ErrorCode::authentication_error);
  EXPECT_THAT(counters.last_error()->message(), HasSubstr("allow_clear_credentials"));
  std::this_thread::sleep_for(300ms);  // and not by a later attempt
  EXPECT_TRUE(counters.connected_clients().empty());
  EXPECT_TRUE(users_->names().empty());
}

TEST_F(FoundServices, GetThemWhereTheProgramSaysSo) {
  Node client;
  client.discovery().listen(listening_at(network_));
  SubscriptionOptions options = as_alice();
  options.allow_clear_credentials = true;
  ServiceSubscription counters = client.subscribe_type("test.counter.Counter", options);
  EXPECT_EQ(counters.wait_default_client<CounterStub>(20s)->get_name(), "found");
  EXPECT_EQ(users_->names(), std::vector<std::string>{"alice"});
}

TEST_F(FoundServices, GetNoneOfAFilterEither) {
  Node client;
  client.discovery().listen(listening_at(network_));
  SubscriptionOptions options{.retry_delay = 50ms};
  options.filter.nodes = {
      {.id = attacker_->id(), .username = "bob", .credentials = {{"password", "secret"}}}};
  ServiceSubscription counters = client.subscribe_type("test.counter.Counter", options);
  ASSERT_TRUE(eventually([&] { return counters.last_error().has_value(); }));
  EXPECT_EQ(counters.last_error()->code(), ErrorCode::authentication_error);
  EXPECT_TRUE(users_->names().empty());
}

TEST_F(FoundServices, GetNoneByTheirUrlsWhoeverConnects) {
  Node client;
  const std::string url = found_url(client);
  const Error error = error_of([&] { client.connect<CounterStub>(url, alice()); });
  EXPECT_EQ(error.code(), ErrorCode::authentication_error);
  const std::string place = url.substr(0, url.find("service="));
  auto known = client.connect<CounterStub>(place + "service=open");
  EXPECT_EQ(error_of([&] {
              known.authenticate("alice", {{"password", "secret"}});
            }).code(),
            ErrorCode::authentication_error);
  ServiceSubscription by_url = client.subscribe(url, as_alice());
  ASSERT_TRUE(eventually([&] { return by_url.last_error().has_value(); }));
  // The same place, written by hand from what was announced.
  const std::string announced = client.discovery().detected_nodes().at(0).urls.at(0);
  const std::string other = announced.substr(0, announced.find("service=")) + "service=counter";
  EXPECT_EQ(error_of([&] { client.connect<CounterStub>(other, alice()); }).code(),
            ErrorCode::authentication_error);
  EXPECT_TRUE(users_->names().empty());
}

TEST_F(FoundServices, GetThemAtAUrlThatTheProgramHasFromElsewhere) {
  Node client;
  found_url(client);
  const std::string url = "rr+tcp://127.0.0.1:" + std::to_string(port_) + "/?service=counter";
  EXPECT_EQ(client.connect<CounterStub>(url, alice())->get_name(), "found");
  EXPECT_EQ(users_->names(), std::vector<std::string>{"alice"});
}

class FoundWithTls : public FoundServices {
 protected:
  FoundWithTls()
      : authority_(
            Authority::create(rr::testing::test_folder() + "/found" + std::to_string(++count_))) {}
  NodeOptions trusting() const {
    NodeOptions options;
    options.tls.authority_files = {authority_.certificate_file()};
    return options;
  }
  NodeOptions certified() {
    NodeOptions options = trusting();
    options.id = NodeId::random();
    options.tls.certificate_file = authority_.issue(options.id);
    return options;
  }

  static inline int count_ = 0;
  Authority authority_;
};

TEST_F(FoundWithTls, GetCredentialsOnceTheyAreCertified) {
  std::unique_ptr<Node> server;
  serve(server, certified());
  Node client(trusting());
  client.discovery().listen(listening_at(network_));
  ServiceSubscription counters = client.subscribe_type("test.counter.Counter", as_alice());
  (void)counters.wait_default_client<CounterStub>(20s);
  const auto clients = counters.connected_clients();
  ASSERT_EQ(clients.size(), 1U);  // and not the one without a certificate
  EXPECT_EQ(clients[0].node, server->id());
}

TEST_F(FoundWithTls, AreNotConnectedToInClearByANodeThatRequiresTls) {
  NodeOptions options = trusting();
  options.tls.is_required = true;
  Node client(options);
  client.discovery().listen(listening_at(network_));
  SubscriptionOptions asked = as_alice();
  asked.allow_clear_credentials = true;
  ServiceSubscription counters = client.subscribe_type("test.counter.Counter", asked);
  EXPECT_EQ(error_of([&] { (void)counters.wait_default_client<CounterStub>(1s); }).code(),
            ErrorCode::operation_timeout);
  EXPECT_TRUE(users_->names().empty());
  std::unique_ptr<Node> server;
  serve(server, certified());
  (void)counters.wait_default_client<CounterStub>(20s);
  EXPECT_EQ(users_->names(), std::vector<std::string>{"alice"});
}

}  // namespace
}  // namespace rr::discovery
