// SPDX-License-Identifier: Apache-2.0
// Pipes and objects of subscriptions, which go on when their service comes back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <boost/asio/use_future.hpp>
#include <chrono>

#include "rr/async.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/pipe_board.hpp"
#include "runtime/cpp/src/node/testing/server.hpp"
#include "runtime/cpp/src/node/testing/two_services.hpp"
#include "runtime/cpp/src/node/testing/wired.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using boost::asio::use_future;

using TwoBoards = Two<PipeBoard, PipeBoardStub>;

TEST(PipeSubscriptions, BringThePacketsOfAllClientsTogether) {
  TwoBoards both;
  auto numbers = both.subscription.subscribe_pipe<double>("numbers");
  EXPECT_TRUE(both.is_at(numbers, 2));
  EXPECT_EQ(code_of([&] { (void)numbers.receive(); }), ErrorCode::invalid_operation);
  EXPECT_EQ(numbers.receive_for(1ms), std::nullopt);
  for (int i = 0; i < 100; ++i) both.first->numbers().send(i);
  for (int i = 0; i < 100; ++i) {
    const auto packet = numbers.receive_for(20s);
    ASSERT_TRUE(packet);
    EXPECT_EQ(packet->packet, i);
    EXPECT_EQ(packet->client.service, "one");
  }
  both.second->numbers().send(5);
  EXPECT_TRUE(eventually([&] { return numbers.available() == 1; }));
  EXPECT_EQ(numbers.receive().client.service, "two");
}

TEST(PipeSubscriptions, GoOnWhenTheServiceComesBack) {
  TwoBoards both;
  auto numbers = both.subscription.subscribe_pipe<double>("numbers", "*");
  EXPECT_TRUE(both.is_at(numbers, 2));
  both.first->numbers().send(1);
  EXPECT_TRUE(eventually([&] { return numbers.available() == 1; }));
  both.one.stop();
  EXPECT_TRUE(both.is_at(numbers, 1));
  both.one.start();
  EXPECT_TRUE(both.is_at(numbers, 2));
  both.first->numbers().send(2);
  EXPECT_EQ(numbers.receive_for(20s)->packet, 1);  // it was kept
  EXPECT_EQ(numbers.receive_for(20s)->packet, 2);
}

TEST(PipeSubscriptions, SendToAllClients) {
  TwoBoards both;
  std::atomic<int> received{0};
  const auto count = [&](PipeEndpoint<std::string> end) {
    end.on_packet([&](const std::string& text) { received += text == "hello"; }).detach();
  };
  both.first->in().on_connect(count);
  both.second->in().on_connect(count);
  auto in = both.subscription.subscribe_pipe<std::string>("in");
  EXPECT_TRUE(both.is_at(in, 2));
  EXPECT_EQ(in.send("hello"), 2U);
  EXPECT_TRUE(eventually([&] { return received == 2; }));
  in.set_backlog_limit(1);
  EXPECT_EQ(in.send("hello"), 2U);
  EXPECT_TRUE(eventually([&] { return received == 4; }));
  auto out = both.subscription.subscribe_pipe<std::int32_t>("out");
  EXPECT_TRUE(both.is_at(out, 2));
  EXPECT_EQ(code_of([&] { out.send(1); }), ErrorCode::read_only_member);
}

TEST(PipeSubscriptions, LoseTheOldestWhenThereIsNoRoom) {
  TwoBoards both;
  auto numbers = both.subscription.subscribe_pipe<double>("numbers", {}, 3);
  EXPECT_TRUE(both.is_at(numbers, 2));
  for (int i = 0; i < 10; ++i) both.first->numbers().send(i);
  EXPECT_TRUE(eventually([&] { return numbers.lost_count() == 7; }));
  EXPECT_EQ(numbers.available(), 3U);
  EXPECT_EQ(numbers.receive().packet, 7);
}

TEST(PipeSubscriptions, GiveTheirPacketsToAFunction) {
  TwoBoards both;
  auto numbers = both.subscription.subscribe_pipe<double>("numbers");
  EXPECT_TRUE(both.is_at(numbers, 2));
  both.first->numbers().send(1);
  EXPECT_TRUE(eventually([&] { return numbers.available() == 1; }));
  std::atomic<double> sum{0};
  auto function = numbers.on_packet([&](double packet, const SubscriptionClientId& client) {
    sum = sum + packet;
    if (client.service == "two") throw std::runtime_error("told to the log");
  });
  both.second->numbers().send(10);
  both.first->numbers().send(100);
  EXPECT_TRUE(eventually([&] { return sum == 111; }));
  function.disconnect();
  both.first->numbers().send(2);
  EXPECT_TRUE(eventually([&] { return numbers.available() == 1; }));
  EXPECT_EQ(numbers.receive().packet, 2);
}

TEST(PipeSubscriptions, OfTheSamePipeHaveEndpointsOfTheirOwn) {
  TwoBoards both;
  auto one = both.subscription.subscribe_pipe<double>("numbers");
  auto other = both.subscription.subscribe_pipe<double>("numbers");
  EXPECT_TRUE(both.is_at(one, 2) && both.is_at(other, 2));
  EXPECT_EQ(both.first->numbers().endpoint_count(), 2U);
  one.close();
  EXPECT_TRUE(eventually([&] { return both.first->numbers().endpoint_count() == 1; }));
  both.first->numbers().send(4);
  EXPECT_EQ(other.receive_for(20s)->packet, 4);
  EXPECT_EQ(one.receive_for(20s), std::nullopt);
}

TEST(SubObjectSubscriptions, GiveTheObjectOfTheDefaultClient) {
  Server server("counter", std::make_shared<Counter>("root"));
  Node node;
  auto subscription = node.subscribe(server.url(), {.retry_delay = 20ms});
  auto child = subscription.subscribe_sub_object<CounterStub>("*.by_name[two%20words]");
  EXPECT_EQ(child.wait_default_client<CounterStub>(20s)->rr_path(), "counter.by_name[two%20words]");
  const auto old = child.default_client<CounterStub>();
  EXPECT_EQ(child.try_default_client<NamedStub>(), old);
  EXPECT_EQ(code_of([&] { (void)child.try_default_client<WiredStub>(); }),
            ErrorCode::service_error);
  server.stop();
  EXPECT_TRUE(eventually([&] { return child.try_default_client<CounterStub>() == nullptr; }));
  EXPECT_EQ(code_of([&] { (void)child.default_client<CounterStub>(); }),
            ErrorCode::connection_error);
  auto soon = child.async_default_client<CounterStub>(20s, use_future);
  server.start();
  EXPECT_NE(soon.get(), old);
  EXPECT_NO_THROW((void)child.default_client<CounterStub>()->get_name());
  child.close();
  EXPECT_EQ(code_of([&] { (void)child.wait_default_client<CounterStub>(20s); }),
            ErrorCode::invalid_operation);
}

TEST(SubObjectSubscriptions, LearnTheTypeThatIsAskedFor) {
  Server server("counter", std::make_shared<Counter>("root"));
  Node node;
  auto subscription = node.subscribe(server.url(), {.retry_delay = 60s});
  auto child = subscription.subscribe_sub_object("*.child");
  EXPECT_TRUE(eventually([&] { return child.last_error().has_value(); }));
  EXPECT_NO_THROW((void)child.wait_default_client<CounterStub>(20s)->get_name());
}

TEST(SubObjectSubscriptions, SayWhyThereIsNone) {
  Server server("counter", std::make_shared<Counter>("root"));
  Node node;
  auto subscription = node.subscribe(server.url(), {.retry_delay = 20ms});
  auto child = subscription.subscribe_sub_object<CounterStub>("*.nobody");
  const Error error = error_of([&] { (void)child.wait_default_client<CounterStub>(200ms); });
  EXPECT_EQ(error.code(), ErrorCode::operation_timeout);
  EXPECT_TRUE(eventually([&] { return child.last_error().has_value(); }));
}

}  // namespace
}  // namespace rr::testing
