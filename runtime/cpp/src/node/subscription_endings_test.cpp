// SPDX-License-Identifier: Apache-2.0
// How subscriptions and their attempts end, and what is left of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <future>
#include <mutex>

#include "rr/subscription.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/server.hpp"
#include "runtime/cpp/src/node/testing/silent_peer.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Clock = std::chrono::steady_clock;

TEST(ServiceSubscriptions, EndAnAttemptThatTakesTooLong) {
  const SilentPeer peer;
  Node node;
  auto subscription = node.subscribe(peer.url(), {.retry_delay = 20ms, .connect_timeout = 50ms});
  EXPECT_TRUE(eventually([&] { return subscription.services().front().failures >= 2; }));
  EXPECT_EQ(subscription.last_error()->code(), ErrorCode::operation_timeout);
}

TEST(ServiceSubscriptions, MayBeClosedWhileTheyConnect) {
  const SilentPeer peer;
  Node node({.connect_timeout = 60s});
  auto subscription = node.subscribe(peer.url(), {.connect_timeout = 60s});
  const int connection = peer.accept();
  auto waiting = std::async(std::launch::async, [&] {
    return code_of([&] { (void)subscription.wait_default_client<CounterStub>(60s); });
  });
  const auto begin = Clock::now();
  subscription.close();
  EXPECT_EQ(waiting.get(), ErrorCode::invalid_operation);
  EXPECT_FALSE(subscription.is_open());
  EXPECT_THAT(subscription.services(), IsEmpty());
  node.shutdown();  // waits for the attempt
  EXPECT_LE(Clock::now() - begin, 10s);
  ::close(connection);
}

TEST(ServiceSubscriptions, EndWithTheirNode) {
  const SilentPeer silent;
  Server server("counter", counter("a"));
  std::mutex mutex;
  std::vector<ErrorCode> codes;
  ServiceSubscription subscription;
  Subscription left;
  std::shared_ptr<CounterStub> client;
  const auto begin = Clock::now();
  {
    Node node({.connect_timeout = 60s});
    subscription = node.subscribe_all({{server.url()}, {silent.url()}}, {.connect_timeout = 60s});
    left = subscription.on_disconnected([&](const SubscriptionClientId&, const Error& error) {
      const std::lock_guard lock(mutex);
      codes.push_back(error.code());
    });
    client = subscription.wait_default_client<CounterStub>(20s);
  }
  EXPECT_LE(Clock::now() - begin, 20s);
  EXPECT_THAT(codes, ElementsAre(ErrorCode::operation_aborted));
  EXPECT_FALSE(subscription.is_open());
  EXPECT_THAT(subscription.connected_clients(), IsEmpty());
  EXPECT_EQ(subscription.try_default_client<CounterStub>(), nullptr);
  EXPECT_EQ(code_of([&] { subscription.update_urls({server.url()}); }),
            ErrorCode::invalid_operation);
  EXPECT_EQ(code_of([&] { (void)subscription.wait_default_client<CounterStub>(1s); }),
            ErrorCode::invalid_operation);
  EXPECT_NE(code_of([&] { (void)client->get_name(); }), ErrorCode::none);
  Node node;
  node.shutdown();
  EXPECT_EQ(code_of([&] { node.subscribe(server.url()); }), ErrorCode::invalid_operation);
}

TEST(ServiceSubscriptions, HandOutStubsThatOutliveThem) {
  Server server("counter", counter("a"));
  Node node;
  auto subscription = node.subscribe(server.url());
  const auto client = subscription.wait_default_client<CounterStub>(20s);
  subscription.close();
  subscription = {};
  EXPECT_EQ(client->rr_path(), "counter");
  EXPECT_TRUE(eventually([&] { return code_of([&] { client->reset(); }) != ErrorCode::none; }));
  EXPECT_TRUE(eventually([&] { return server.client_count() == 0; }));
}

TEST(ServiceSubscriptions, FreeTheirFunctionsWhenTheyEnd) {
  Server server("counter", counter("a"));
  Node node;
  auto subscription = node.subscribe(server.url(), {.retry_delay = 20ms});
  auto owned = std::make_shared<int>(1);
  const std::weak_ptr<int> watch = owned;
  subscription.on_connected([owned](const SubscriptionClientId&) {}).detach();
  subscription.on_failed([owned](const std::vector<std::string>&, const Error&) {}).detach();
  owned.reset();
  EXPECT_FALSE(watch.expired());
  subscription.close();
  EXPECT_TRUE(eventually([&] { return watch.expired(); }));
}

TEST(ServiceSubscriptions, KeepNothingOfAHundredConnections) {
  Server server("counter", counter("a"));
  Node node;
  auto subscription = node.subscribe(server.url(), {.retry_delay = 1ms});
  std::vector<std::weak_ptr<Session>> sessions;
  std::shared_ptr<CounterStub> last;
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(eventually([&] {
      const auto client = subscription.try_default_client<CounterStub>();
      const bool is_new = client && client != last;
      if (is_new) last = client;
      return is_new;
    }));
    sessions.push_back(last->rr_session());
    const auto client = subscription.claim_client(last);  // which closes it when it goes
  }
  last.reset();
  subscription.close();
  for (const auto& session : sessions) {
    EXPECT_TRUE(eventually([&] { return session.expired(); }));
  }
  EXPECT_TRUE(eventually([&] { return server.client_count() == 0; }));
}

}  // namespace
}  // namespace rr::testing
