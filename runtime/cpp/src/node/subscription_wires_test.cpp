// SPDX-License-Identifier: Apache-2.0
// Wires of subscriptions, which go on when their service comes back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>

#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/server.hpp"
#include "runtime/cpp/src/node/testing/two_services.hpp"
#include "runtime/cpp/src/node/testing/wired.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using TwoWired = Two<Wired, WiredStub>;

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

// What a Wired is to a service that is newer, or older, than its clients.
constexpr std::string_view other_text =
    "service test.wired\nstdver 0.10\nobject Wired\n  wire string level\nend\n";
extern const ObjectType rr_OtherWired;
constexpr Member other_members[] = {wire<std::string>("level")};
constexpr const ObjectType* other_objects[] = {&rr_OtherWired};
constinit const Definition other_definition{"test.wired", other_text, {0, 10, 0, 0}, {},
                                            {},           {},         other_objects};
constinit const ObjectType rr_OtherWired{
    "test.wired.Wired", other_definition, {}, other_members, nullptr};

class OtherWired final : public Skeleton {
 public:
  [[nodiscard]] const ObjectType& rr_object_type() const override { return rr_OtherWired; }
  void rr_dispatch(std::size_t, Request&) override {}
  std::shared_ptr<Skeleton> rr_child(std::size_t, const ObjectIndex&) override { return nullptr; }
  [[nodiscard]] WireServer<std::string> level() const { return {*this, other_members[0]}; }
};

TEST(WireSubscriptions, ReportAServiceThatDeclaresAnotherType) {
  Node node;
  Node offering;
  offering.register_service("one", std::make_shared<OtherWired>());
  const std::uint16_t port = offering.listen_tcp(0, "127.0.0.1");
  auto subscription =
      node.subscribe("rr+tcp://127.0.0.1:" + std::to_string(port) + "/?service=one");
  subscription.use_types<WiredStub>();
  auto level = subscription.subscribe_wire<double>("level");
  ASSERT_TRUE(eventually([&] { return level.last_error().has_value(); }));
  EXPECT_EQ(level.last_error()->code(), ErrorCode::data_type_mismatch);
  EXPECT_THAT(level.last_error()->message(),
              HasSubstr("is `wire double` here and `wire string` at the service"));
  EXPECT_TRUE(level.clients().empty());
}

TEST(WireSubscriptions, ReportAServiceThatDeclaresAnotherTypeThanOneThatIsNamedAfterConnecting) {
  Node node;
  Node offering;
  offering.register_service("one", std::make_shared<OtherWired>());
  const std::uint16_t port = offering.listen_tcp(0, "127.0.0.1");
  auto subscription =
      node.subscribe("rr+tcp://127.0.0.1:" + std::to_string(port) + "/?service=one");
  auto level = subscription.subscribe_wire<double>("level");
  ASSERT_TRUE(eventually([&] { return level.last_error().has_value(); }));
  EXPECT_NE(level.last_error()->code(), ErrorCode::data_type_mismatch);
  subscription.use_types<WiredStub>();
  EXPECT_TRUE(eventually([&] {
    const auto why = level.last_error();
    return why && why->code() == ErrorCode::data_type_mismatch;
  }));
  EXPECT_TRUE(level.clients().empty());
}

TEST(WireSubscriptions, ReportAServiceWhoseValuesHaveAnotherType) {
  Node node({.definition_check = DefinitionCheck::off});
  Node offering;
  const auto other = std::make_shared<OtherWired>();
  offering.register_service("one", other);
  const std::uint16_t port = offering.listen_tcp(0, "127.0.0.1");
  auto subscription =
      node.subscribe("rr+tcp://127.0.0.1:" + std::to_string(port) + "/?service=one");
  subscription.use_types<WiredStub>();
  auto level = subscription.subscribe_wire<double>("level");
  std::atomic<int> told{0};
  const auto failures = level.on_failed(
      [&](const SubscriptionClientId& client, const Error&) { told += client.service == "one"; });
  EXPECT_TRUE(TwoWired::is_at(level, 1));
  EXPECT_EQ(level.last_error(), std::nullopt);
  other->level().set_in("high");
  ASSERT_TRUE(eventually([&] { return level.last_error().has_value(); }));
  EXPECT_EQ(level.last_error()->code(), ErrorCode::data_type_mismatch);
  EXPECT_THAT(level.last_error()->message(), HasSubstr("`one.level` has values of another type"));
  EXPECT_FALSE(level.try_in());
  EXPECT_TRUE(eventually([&] { return told == 1; }));
  other->level().set_in("higher");  // the same again is not told again
  EXPECT_TRUE(TwoWired::is_at(level, 1));
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
