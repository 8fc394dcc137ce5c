// SPDX-License-Identifier: Apache-2.0
// Connections of subscriptions: how they come, fail and come back.
#include "rr/subscription.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <boost/asio/use_future.hpp>
#include <chrono>
#include <future>
#include <mutex>

#include "rr/async.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/server.hpp"
#include "runtime/cpp/src/node/testing/wired.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using boost::asio::use_future;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Clock = std::chrono::steady_clock;

SubscriptionOptions quick() { return {.retry_delay = 20ms}; }

// The codes of errors that come on any thread.
class Codes {
 public:
  void add(const Error& error) {
    const std::lock_guard lock(mutex_);
    codes_.push_back(error.code());
    times_.push_back(Clock::now());
  }
  [[nodiscard]] std::vector<ErrorCode> all() {
    const std::lock_guard lock(mutex_);
    return codes_;
  }
  [[nodiscard]] std::vector<Clock::time_point> times() {
    const std::lock_guard lock(mutex_);
    return times_;
  }
  [[nodiscard]] bool has(ErrorCode code) {
    const std::lock_guard lock(mutex_);
    return std::find(codes_.begin(), codes_.end(), code) != codes_.end();
  }

 private:
  std::mutex mutex_;
  std::vector<ErrorCode> codes_;
  std::vector<Clock::time_point> times_;
};

TEST(ServiceSubscriptions, GiveTheDefaultClientOnceConnected) {
  Server server("counter", counter("a"));
  Node node;
  auto subscription = node.subscribe(server.url());
  const auto client = subscription.wait_default_client<CounterStub>(20s);
  EXPECT_EQ(client->get_name(), "a");
  EXPECT_EQ(subscription.try_default_client<CounterStub>(), client);
  EXPECT_EQ(subscription.default_client<NamedStub>()->get_name(), "a");
  const SubscriptionClientId id{server.id(), "counter"};
  EXPECT_THAT(subscription.connected_clients(), ElementsAre(id));
  EXPECT_EQ(subscription.client<CounterStub>(id), client);
  EXPECT_EQ(subscription.client<CounterStub>({id.node, "other"}), nullptr);
  EXPECT_EQ(subscription.last_error(), std::nullopt);
  EXPECT_EQ(code_of([&] { (void)subscription.default_client<WiredStub>(); }),
            ErrorCode::service_error);
}

TEST(ServiceSubscriptions, TellWhichObjectsAreReleased) {
  Server server("counter", counter("a"));
  std::promise<std::string> released;
  SubscriptionOptions options;
  options.on_path_released = [&](const std::string& path) { released.set_value(path); };
  Node node;
  auto subscription = node.subscribe(server.url(), options);
  subscription.wait_default_client<CounterStub>(20s)->get_by_name("left");
  server.service()->release_path("counter.by_name[left]");
  EXPECT_EQ(released.get_future().get(), "counter.by_name[left]");
}

TEST(ServiceSubscriptions, HaveTheAttributesOfTheirServices) {
  Server server("counter", counter("a"), {},
                {.attributes = {{"place", VarValue(std::string("roof"))}}});
  Node node;
  auto subscription = node.subscribe(server.url(), quick());
  (void)subscription.wait_default_client<CounterStub>(20s);
  EXPECT_EQ(subscription.services().front().attributes.at("place").get<std::string>(), "roof");
  server.stop();
  EXPECT_TRUE(eventually([&] { return subscription.services().front().attributes.empty(); }));
}

TEST(ServiceSubscriptions, AreToldWhatIsNoUrl) {
  Node node;
  const auto refused = ErrorCode::invalid_argument;
  EXPECT_EQ(code_of([&] { node.subscribe("nonsense"); }), refused);
  EXPECT_EQ(code_of([&] { node.subscribe("rr+tcp://127.0.0.1:1/"); }), refused);
  EXPECT_EQ(code_of([&] { node.subscribe(std::vector<std::string>{}); }), refused);
  EXPECT_EQ(code_of([&] { node.subscribe_all({}); }), refused);
  EXPECT_EQ(code_of([&] {
              node.subscribe(
                  std::vector<std::string>{"rr+tcp://h:1/?service=a", "rr+tcp://h:1/?service=b"});
            }),
            refused);
  ServiceSubscription none;
  EXPECT_FALSE(none.is_open());
  none.close();
  EXPECT_EQ(code_of([&] { (void)none.connected_clients(); }), ErrorCode::invalid_operation);
}

TEST(ServiceSubscriptions, WaitForAServiceThatStartsLate) {
  Server server("counter", counter("late"));
  server.stop();
  const std::string url = server.url();
  Node node;
  auto subscription = node.subscribe(url, quick());
  Codes codes;
  std::atomic<bool> has_urls{false};
  const auto failed =
      subscription.on_failed([&](const std::vector<std::string>& urls, const Error& error) {
        has_urls = urls == std::vector{url};
        codes.add(error);
      });
  EXPECT_TRUE(eventually([&] { return codes.all().size() >= 2; }));
  EXPECT_TRUE(has_urls);
  EXPECT_EQ(subscription.last_error()->code(), ErrorCode::connection_error);
  EXPECT_FALSE(subscription.services().front().is_connected);
  EXPECT_GE(subscription.services().front().failures, 2U);
  EXPECT_EQ(subscription.try_default_client<CounterStub>(), nullptr);
  const Error why = error_of([&] { (void)subscription.default_client<CounterStub>(); });
  EXPECT_EQ(why.code(), ErrorCode::connection_error);
  EXPECT_THAT(why.message(), HasSubstr("cannot connect"));
  const Error over = error_of([&] { (void)subscription.wait_default_client<CounterStub>(1ms); });
  EXPECT_EQ(over.code(), ErrorCode::operation_timeout);
  EXPECT_THAT(over.message(), HasSubstr("cannot connect"));
  server.start();
  EXPECT_EQ(subscription.wait_default_client<CounterStub>(20s)->get_name(), "late");
  EXPECT_EQ(subscription.last_error(), std::nullopt);
  EXPECT_EQ(subscription.services().front().failures, 0U);
}

TEST(ServiceSubscriptions, ConnectAgainWhenTheServiceComesBackAtItsPort) {
  Server server("counter", counter("a"));
  Node node;
  auto subscription = node.subscribe(server.url(), quick());
  std::atomic<int> connected{0};
  std::atomic<int> disconnected{0};
  const auto came = subscription.on_connected([&](const SubscriptionClientId&) { ++connected; });
  const auto left = subscription.on_disconnected([&](const SubscriptionClientId& id, const Error&) {
    disconnected += id.service == "counter";
  });
  const auto old = subscription.wait_default_client<CounterStub>(20s);
  server.stop();
  EXPECT_TRUE(eventually([&] { return disconnected == 1; }));
  EXPECT_THAT(subscription.connected_clients(), IsEmpty());
  EXPECT_NE(code_of([&] { (void)old->get_name(); }), ErrorCode::none);
  server.start();
  EXPECT_EQ(subscription.wait_default_client<CounterStub>(20s)->get_name(), "a");
  EXPECT_TRUE(eventually([&] { return connected == 2; }));
  EXPECT_NE(code_of([&] { (void)old->get_name(); }), ErrorCode::none);  // as documented
}

TEST(ServiceSubscriptions, ComeBackWithinTwiceTheRetryDelay) {
  Server server("counter", counter("a"));
  Node node;
  auto subscription = node.subscribe(server.url(), {.retry_delay = 500ms});
  (void)subscription.wait_default_client<CounterStub>(20s);
  server.stop();
  EXPECT_TRUE(eventually([&] { return subscription.services().front().failures >= 1; }));
  server.start();
  const auto begin = Clock::now();
  (void)subscription.wait_default_client<CounterStub>(20s);
  EXPECT_LE(Clock::now() - begin, 1000ms);
}

TEST(ServiceSubscriptions, KeepSeveralServices) {
  Server first("counter", counter("first"));
  Server second("counter", counter("second"));
  Node node;
  auto subscription = node.subscribe(first.url(), quick());
  (void)subscription.wait_default_client<CounterStub>(20s);
  subscription.update_services({{second.url()}, {first.url()}});
  EXPECT_TRUE(eventually([&] { return subscription.connected_clients().size() == 2; }));
  EXPECT_EQ(subscription.default_client<CounterStub>()->get_name(), "first");  // it was not closed
  EXPECT_EQ(subscription.client<CounterStub>({second.id(), "counter"})->get_name(), "second");
  first.stop();
  EXPECT_TRUE(eventually([&] { return subscription.connected_clients().size() == 1; }));
  EXPECT_EQ(subscription.default_client<CounterStub>()->get_name(), "second");
  first.start();
  EXPECT_TRUE(eventually([&] { return subscription.connected_clients().size() == 2; }));
  EXPECT_EQ(subscription.default_client<CounterStub>()->get_name(), "second");
}

TEST(ServiceSubscriptions, TryTheUrlsOfAServiceInTheirOrder) {
  Server gone("counter", counter("gone"));
  Server there("counter", counter("there"));
  gone.stop();
  Node node;
  auto subscription = node.subscribe(std::vector{gone.url(), there.url(), gone.url()}, quick());
  EXPECT_EQ(subscription.wait_default_client<CounterStub>(20s)->get_name(), "there");
  EXPECT_EQ(subscription.services().front().failures, 0U);
}

TEST(ServiceSubscriptions, MoveToOtherUrls) {
  Server first("counter", counter("first"));
  Server second("counter", counter("second"));
  Node node;
  auto subscription = node.subscribe(first.url(), quick());
  const auto client = subscription.wait_default_client<CounterStub>(20s);
  subscription.update_urls({second.url(), first.url()});
  EXPECT_EQ(subscription.default_client<CounterStub>(), client);
  subscription.update_urls({second.url()});
  EXPECT_EQ(subscription.wait_default_client<CounterStub>(20s)->get_name(), "second");
  EXPECT_TRUE(eventually([&] { return first.client_count() == 0; }));
  EXPECT_EQ(code_of([&] { subscription.update_urls({}); }), ErrorCode::invalid_argument);
  subscription.close();
  EXPECT_EQ(code_of([&] { subscription.update_urls({first.url()}); }),
            ErrorCode::invalid_operation);
}

TEST(ServiceSubscriptions, SayWhyAnAttemptHasFailed) {
  class OnlyAlice : public Users {
   public:
    [[nodiscard]] User authenticate(const std::string& name,
                                    const std::map<std::string, VarValue>& credentials,
                                    const NodeId& /*node*/) const override {
      const auto password = credentials.find("password");
      if (password == credentials.end() || password->second.get<std::string>() != "right") {
        throw Error(ErrorCode::authentication_error, "Invalid credentials");
      }
      return {name};
    }
  };
  Server server("counter", counter("a"), {}, {.users = std::make_shared<OnlyAlice>()});
  Node node;
  const auto last = [&](const ServiceSubscription& subscription) {
    EXPECT_TRUE(eventually([&] { return subscription.last_error().has_value(); }));
    return subscription.last_error()->code();
  };
  const auto with = [](const std::string& password) {
    return SubscriptionOptions{.username = "alice", .credentials = {{"password", password}}};
  };
  EXPECT_EQ(last(node.subscribe(server.url(), with("wrong"))), ErrorCode::authentication_error);
  EXPECT_EQ(last(node.subscribe(server.url())), ErrorCode::authentication_error);
  EXPECT_EQ(last(node.subscribe(server.url("other"), with("right"))), ErrorCode::service_not_found);
  auto typed = with("right");
  typed.object_type = "test.wired.Wired";
  EXPECT_EQ(last(node.subscribe(server.url(), typed)), ErrorCode::service_error);
  typed.object_type = "test.counter.Named";
  EXPECT_EQ(node.subscribe(server.url(), typed).wait_default_client<CounterStub>(20s)->get_name(),
            "a");
}

TEST(ServiceSubscriptions, WaitLongerFromFailureToFailure) {
  Server server("counter", counter("a"));
  server.stop();
  Node node;
  const auto begin = Clock::now();
  auto subscription = node.subscribe(server.url(), {.retry_delay = 10ms, .max_retry_delay = 80ms});
  Codes codes;
  const auto failed = subscription.on_failed(
      [&](const std::vector<std::string>&, const Error& error) { codes.add(error); });
  EXPECT_TRUE(eventually([&] { return codes.all().size() >= 7; }));
  // At once, then after 10, 20, 40, 80, 80 and 80 ms. The function may hear of one late, of the
  // next in time, and of the first not at all.
  EXPECT_GE(codes.times()[6] - begin, 300ms);
}

TEST(ServiceSubscriptions, AreWaitedForAsynchronously) {
  Server server("counter", counter("a"));
  server.stop();
  Node node;
  auto subscription = node.subscribe(server.url(), quick());
  auto soon = subscription.async_default_client<CounterStub>(20s, use_future);
  auto never = subscription.async_default_client<CounterStub>(1ms, use_future);
  EXPECT_EQ(code_of([&] { never.get(); }), ErrorCode::operation_timeout);
  EXPECT_EQ(soon.wait_for(0ms), std::future_status::timeout);
  server.start();
  EXPECT_EQ(soon.get()->get_name(), "a");
  auto wrong = subscription.async_default_client<WiredStub>(20s, use_future);
  EXPECT_EQ(code_of([&] { wrong.get(); }), ErrorCode::service_error);
  server.stop();
  EXPECT_TRUE(eventually([&] { return subscription.connected_clients().empty(); }));
  auto late = subscription.async_default_client<CounterStub>(20s, use_future);
  subscription.close();
  EXPECT_EQ(code_of([&] { late.get(); }), ErrorCode::invalid_operation);
}

TEST(ServiceSubscriptions, TellFunctionsThatMayDoAnything) {
  Server server("counter", counter("a"));
  Node node;
  auto subscription = node.subscribe(server.url(), quick());
  std::promise<std::string> name;
  auto came = subscription.on_connected([&](const SubscriptionClientId& id) {
    name.set_value(subscription.client<CounterStub>(id)->get_name());
    subscription.close();
    throw std::runtime_error("told to the log");
  });
  EXPECT_EQ(name.get_future().get(), "a");
  EXPECT_TRUE(eventually([&] { return !subscription.is_open(); }));
  EXPECT_EQ(code_of([&] { (void)subscription.on_connected([](const SubscriptionClientId&) {}); }),
            ErrorCode::invalid_operation);
}

}  // namespace
}  // namespace rr::testing
