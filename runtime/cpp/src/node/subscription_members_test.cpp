// SPDX-License-Identifier: Apache-2.0
// Wires, pipes and objects of subscriptions, which go on when their service comes back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <boost/asio/use_future.hpp>
#include <chrono>
#include <mutex>

#include "rr/async.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/pipe_board.hpp"
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

ErrorCode code_of(const std::function<void()>& what) { return error_of(what).code(); }

// Two services of different names, and a subscription to both.
template <class Object, class RootStub>
struct Two {
  Two() { subscription.use_types<RootStub>(); }

  std::shared_ptr<Object> first = std::make_shared<Object>();
  std::shared_ptr<Object> second = std::make_shared<Object>();
  Server one{"one", first};
  Server two{"two", second};
  Node node;
  ServiceSubscription subscription =
      node.subscribe_all({{one.url()}, {two.url()}}, {.retry_delay = 20ms});

  [[nodiscard]] static bool is_at(const MemberSubscription& member, std::size_t count) {
    return eventually([&] { return member.clients().size() == count; });
  }
};

using TwoWired = Two<Wired, WiredStub>;
using TwoBoards = Two<PipeBoard, PipeBoardStub>;

TEST(WireSubscriptions, GiveTheNewestValueOfAllClients) {
  TwoWired both;
  auto level = both.subscription.subscribe_wire<double>("level");
  EXPECT_TRUE(both.is_at(level, 2));
  EXPECT_EQ(code_of([&] { (void)level.in(); }), ErrorCode::value_not_set);
  EXPECT_FALSE(level.wait_in(1ms));
  both.first->level().set_in(1.5);
  EXPECT_TRUE(level.wait_in(20s));
  EXPECT_EQ(level.in(), 1.5);
  EXPECT_EQ(level.try_in()->client.service, "one");
  EXPECT_EQ(level.try_in()->client.node, both.one.id());
  EXPECT_GT(level.try_in()->time.seconds, 0);
  both.second->level().set_in(2.5);
  EXPECT_TRUE(eventually([&] { return level.in() == 2.5; }));
  const auto all = level.all_in();
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].value, 1.5);
  EXPECT_EQ(all[1].value, 2.5);
  EXPECT_EQ(all[1].client.service, "two");
}

TEST(WireSubscriptions, GoOnWhenTheServiceComesBack) {
  TwoWired both;
  auto level = both.subscription.subscribe_wire<double>("level", "*");
  std::atomic<double> told{0};
  const auto function =
      level.on_in([&](double value, const TimeSpec&, const SubscriptionClientId& client) {
        if (client.service == "one") told = value;
      });
  EXPECT_TRUE(both.is_at(level, 2));
  both.first->level().set_in(1);
  EXPECT_TRUE(eventually([&] { return told == 1; }));
  both.one.stop();
  EXPECT_TRUE(both.is_at(level, 1));
  EXPECT_EQ(level.in(), 1);  // as without a lifespan
  EXPECT_THAT(level.all_in(), IsEmpty());
  both.one.start();
  EXPECT_TRUE(both.is_at(level, 2));
  both.first->level().set_in(2);
  EXPECT_TRUE(eventually([&] { return told == 2; }));
  EXPECT_EQ(level.in(), 2);
  EXPECT_EQ(level.set_out(7), 2U);
  EXPECT_TRUE(eventually([&] {
    const auto out = both.first->level().out();
    return out && out->value == 7;
  }));
  EXPECT_TRUE(eventually([&] { return both.second->level().out().has_value(); }));
}

TEST(WireSubscriptions, AreConnectedAgainWhenTheServiceClosesTheWire) {
  TwoWired both;
  auto level = both.subscription.subscribe_wire<double>("level");
  EXPECT_TRUE(both.is_at(level, 2));
  both.first->level().connections().front().close();
  EXPECT_TRUE(eventually([&] { return both.first->level().connection_count() == 1; }));
  EXPECT_TRUE(both.is_at(level, 2));
  both.first->level().set_in(3);
  EXPECT_TRUE(eventually([&] { return level.try_in() && level.in() == 3; }));
}

TEST(WireSubscriptions, TellFunctionsWhatIsThereAndWhatComes) {
  TwoWired both;
  auto level = both.subscription.subscribe_wire<double>("level");
  EXPECT_TRUE(both.is_at(level, 2));
  both.first->level().set_in(1);
  both.second->level().set_in(2);
  EXPECT_TRUE(eventually([&] { return level.all_in().size() == 2; }));
  std::mutex mutex;
  std::vector<double> told;
  auto function = level.on_in([&](double value, const TimeSpec&, const SubscriptionClientId&) {
    const std::lock_guard lock(mutex);
    told.push_back(value);
    if (value == 1) throw std::runtime_error("told to the log");
  });
  const auto has = [&](std::size_t count) {
    const std::lock_guard lock(mutex);
    return told.size() == count;
  };
  EXPECT_TRUE(eventually([&] { return has(2); }));
  both.second->level().set_in(3);
  EXPECT_TRUE(eventually([&] { return has(3); }));
  EXPECT_EQ(told.back(), 3);
  function.disconnect();
  both.second->level().set_in(4);
  EXPECT_TRUE(eventually([&] { return level.in() == 4; }));
  EXPECT_TRUE(has(3));
}

TEST(WireSubscriptions, ForgetValuesAfterTheirLifespan) {
  TwoWired both;
  auto level = both.subscription.subscribe_wire<double>("level");
  level.set_lifespan(30ms);
  EXPECT_TRUE(both.is_at(level, 2));
  both.first->level().set_in(1);
  EXPECT_TRUE(level.wait_in(20s));
  EXPECT_TRUE(eventually([&] { return !level.try_in() && level.all_in().empty(); }));
}

TEST(WireSubscriptions, SayWhatIsWrong) {
  TwoWired both;
  (void)both.subscription.wait_default_client<WiredStub>(20s);
  const auto last = [](const MemberSubscription& member) {
    EXPECT_TRUE(eventually([&] { return member.last_error().has_value(); }));
    return member.last_error()->code();
  };
  auto& subscription = both.subscription;
  EXPECT_EQ(last(subscription.subscribe_wire<double>("nothing")), ErrorCode::member_not_found);
  EXPECT_EQ(last(subscription.subscribe_wire<std::int32_t>("level")),
            ErrorCode::data_type_mismatch);
  EXPECT_EQ(last(subscription.subscribe_pipe<double>("level")), ErrorCode::member_not_found);
  EXPECT_EQ(last(subscription.subscribe_wire<double>("level", "*.nothing")),
            ErrorCode::member_not_found);
  EXPECT_EQ(code_of([&] { (void)subscription.subscribe_wire<double>("level", "a..b"); }),
            ErrorCode::invalid_argument);
  std::atomic<int> count{0};
  auto wrong = subscription.subscribe_wire<double>("wrong");
  const auto told = wrong.on_failed([&](const SubscriptionClientId&, const Error& error) {
    count += error.code() == ErrorCode::member_not_found;
  });
  EXPECT_TRUE(eventually([&] { return count >= 4; }));  // tried again
  auto reading = subscription.subscribe_wire<double>("reading");
  EXPECT_TRUE(both.is_at(reading, 2));
  EXPECT_EQ(code_of([&] { reading.set_out(1); }), ErrorCode::read_only_member);
  EXPECT_EQ(reading.last_error(), std::nullopt);
}

TEST(WireSubscriptions, AreConnectedOnceTheProgramKnowsTheType) {
  Server server("one", std::make_shared<Wired>());
  Node node;
  auto subscription = node.subscribe(server.url(), {.retry_delay = 60s});
  auto level = subscription.subscribe_wire<double>("level");
  EXPECT_TRUE(eventually([&] { return level.last_error().has_value(); }));
  EXPECT_EQ(level.last_error()->code(), ErrorCode::service_error);
  EXPECT_THAT(level.last_error()->message(), HasSubstr("does not know"));
  subscription.use_types<WiredStub>();
  EXPECT_TRUE(TwoWired::is_at(level, 1));
  EXPECT_EQ(level.last_error(), std::nullopt);
}

TEST(WireSubscriptions, OfTheSameWireAreOne) {
  TwoWired both;
  auto level = both.subscription.subscribe_wire<double>("level");
  auto same = both.subscription.subscribe_wire<double>("level", "*");
  EXPECT_TRUE(both.is_at(same, 2));
  EXPECT_EQ(code_of([&] { (void)both.subscription.subscribe_wire<float>("level"); }),
            ErrorCode::invalid_operation);
  same.close();
  EXPECT_FALSE(level.is_open());
  EXPECT_FALSE(level.wait_in(20s));
  EXPECT_EQ(code_of([&] { level.set_out(1); }), ErrorCode::invalid_operation);
  EXPECT_TRUE(eventually([&] { return both.first->level().connection_count() == 0; }));
  auto again = both.subscription.subscribe_wire<double>("level");
  EXPECT_TRUE(both.is_at(again, 2));
  both.subscription.close();
  EXPECT_FALSE(again.is_open());
  EXPECT_EQ(code_of([&] { (void)both.subscription.subscribe_wire<double>("level"); }),
            ErrorCode::invalid_operation);
}

TEST(WireSubscriptions, LeaveTheWiresOfClaimedClients) {
  Server server("one", std::make_shared<Wired>());
  Node node;
  auto subscription = node.subscribe(server.url());
  auto client = subscription.claim_client(subscription.wait_default_client<WiredStub>(20s));
  auto level = subscription.subscribe_wire<double>("level");
  EXPECT_TRUE(TwoWired::is_at(level, 1));
  EXPECT_EQ(code_of([&] { (void)client->level().connect(); }), ErrorCode::invalid_operation);
  subscription.close();
  EXPECT_TRUE(eventually(
      [&] { return code_of([&] { (void)client->level().connect(); }) == ErrorCode::none; }));
}

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

TEST(WireSubscriptions, OfAnObjectBelowTheRoot) {
  Server server("one", std::make_shared<Wired>());
  Node node;
  auto subscription = node.subscribe(server.url(), {.retry_delay = 20ms});
  auto level = subscription.subscribe_wire<double>("level", "*.child[x]");
  const auto root = subscription.wait_default_client<WiredStub>(20s);
  EXPECT_TRUE(TwoWired::is_at(level, 1));
  root->get_child("x")->set_level(6);
  EXPECT_TRUE(level.wait_in(20s));
  EXPECT_EQ(level.in(), 6);
}

}  // namespace
}  // namespace rr::testing
