// SPDX-License-Identifier: Apache-2.0
// What all of a node shares, its timers, and how code of the program is called.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "rr/definition.hpp"
#include "rr/error.hpp"
#include "rr/url.hpp"
#include "runtime/cpp/src/channel/pipe_ring.hpp"
#include "runtime/cpp/src/channel/status.hpp"
#include "runtime/cpp/src/channel/wire_slots.hpp"
#include "runtime/cpp/src/endpoint/core.hpp"
#include "runtime/cpp/src/endpoint/testing/fake_connection.hpp"
#include "runtime/cpp/src/endpoint/timer.hpp"
#include "runtime/cpp/src/endpoint/user_code.hpp"

namespace rr::endpoint {
namespace {

using std::chrono_literals::operator""h;
using std::chrono_literals::operator""ms;
using ::testing::Contains;
using ::testing::HasSubstr;

template <class Run>
ErrorCode failure(const Run& run) {
  try {
    run();
  } catch (const Error& error) {
    return error.code();
  }
  return ErrorCode::none;
}

class CoreTest : public ::testing::Test {
 protected:
  ~CoreTest() override { core_->stop(); }

  static NodeOptions options() {
    NodeOptions options;
    options.name = "board";
    options.max_threads = 4;
    return options;
  }
  std::shared_ptr<Core> make(NodeOptions options) {
    options.log = [this](LogLevel, std::string_view text) {
      const MutexLock lock(mutex_);
      lines_.emplace_back(text);
    };
    return std::make_shared<Core>(std::move(options));
  }
  std::vector<std::string> lines() {
    const MutexLock lock(mutex_);
    return lines_;
  }

  Mutex mutex_;
  std::vector<std::string> lines_ RR_GUARDED_BY(mutex_);
  const std::shared_ptr<Core> core_ = make(options());
};

TEST_F(CoreTest, CountsMemoriesAndThreadsOfSlots) {
  const auto core = make(options());
  EXPECT_TRUE(core->slot_threads()->draw(0)) << "one of four threads";
  EXPECT_FALSE(core->slot_threads()->draw(0));
  EXPECT_FALSE(core->slot_budget()->draw(std::size_t{257} * 1024 * 1024));
  EXPECT_TRUE(core->slot_budget()->draw(std::size_t{256} * 1024 * 1024));
}

// What a connection has that shares no memory.
TEST(Connections, HaveNoSlotsByThemselves) {
  rr::testing::FakeConnection fake;
  channel::Connection& connection = fake;
  EXPECT_FALSE(connection.shares_slots());
  EXPECT_EQ(connection.take_slots(1, std::nullopt), nullptr);
  EXPECT_EQ(connection.take_ring({.id = 1}), nullptr);
  EXPECT_EQ(connection.draw_holds(), nullptr);
  std::error_code error;
  const auto slots = channel::SlotWriter::make(channel::SlotSizes::for_value(1), 1, error);
  if (!slots) GTEST_SKIP() << "this system has no shared memory";
  EXPECT_FALSE(connection.pass_memory(slots->handle()));
}

TEST_F(CoreTest, IsNamedAndHasAnId) {
  EXPECT_EQ(core_->name(), "board");
  EXPECT_FALSE(core_->id().is_any());
  EXPECT_EQ(core_->options().name, "board");
  const channel::ChannelContext context = core_->context();
  EXPECT_EQ(context.options.get(), &core_->options());
  EXPECT_EQ(context.reactor.get(), &core_->reactor());
  EXPECT_EQ(core_->pools().sessions->held(), 0U);
  EXPECT_EQ(core_->status(), nullptr);
  EXPECT_EQ(failure([&] { make(NodeOptions{.name = "no name"}); }), ErrorCode::invalid_argument);
}

TEST_F(CoreTest, ShowsItsStateWhereThatIsAskedFor) {
  NodeOptions shown = options();
  shown.metrics.is_enabled = true;
  const auto core = make(std::move(shown));
  ASSERT_NE(core->status(), nullptr);
  EXPECT_THAT(core->status()->metrics(), HasSubstr("node_name=\"board\""));
  EXPECT_THAT(core->status()->metrics(), HasSubstr("robdef_threads{state=\"held\"} 0\n"));
  EXPECT_NE(core->reactor().metrics(), nullptr);
  EXPECT_EQ(core->reactor().shared_metrics().get(), core->reactor().metrics());
}

TEST_F(CoreTest, StartsAndStopsItsThreads) {
  core_->start();
  EXPECT_GE(core_->reactor().live_threads(), 2U);
  EXPECT_FALSE(core_->reactor().is_stopping());
  core_->stop();
  EXPECT_TRUE(core_->reactor().is_stopping());
  EXPECT_EQ(failure([&] { auto timer = core_->after(1ms, [] {}); }), ErrorCode::invalid_operation);
}

TEST_F(CoreTest, KnowsDefinitions) {
  static const Definition first{"test.one", "service test.one\n", {0, 10, 0, 0}, {}, {}, {}, {}};
  const auto before = core_->types();
  EXPECT_EQ(before->find_definition("test.one"), nullptr);
  core_->add_definition(first);
  EXPECT_EQ(core_->types()->find_definition("test.one"), &first);
  EXPECT_EQ(before->find_definition("test.one"), nullptr) << "does not change";
  const auto known = core_->types();
  core_->add_definition(first);
  EXPECT_EQ(core_->types(), known) << "nothing new";
  auto kept = std::make_shared<const Definition>(
      Definition{"test.two", "service test.two\n", {0, 10, 0, 0}, {}, {}, {}, {}});
  const std::weak_ptr<const Definition> watch = kept;
  core_->keep_definition(std::move(kept));
  EXPECT_FALSE(watch.expired());
  EXPECT_EQ(core_->types()->find_definition("test.two"), watch.lock().get());
}

TEST_F(CoreTest, EndpointsHaveNumbersOfTheirOwn) {
  std::set<std::uint32_t> numbers;
  for (int i = 0; i < 100; ++i) numbers.insert(core_->new_endpoint());
  EXPECT_EQ(numbers.size(), 100U);
  EXPECT_FALSE(numbers.contains(0));
  core_->release_endpoint(*numbers.begin());
  EXPECT_NE(core_->new_endpoint(), 0U);
}

TEST_F(CoreTest, HasAChannelForEachScheme) {
  EXPECT_EQ(failure([&] { core_->channel("rr+tcp"); }), ErrorCode::none);
  EXPECT_EQ(failure([&] { core_->channel("mine"); }), ErrorCode::invalid_argument);
  const std::shared_ptr<channel::Channel> tcp = channel::make_tcp_channel(core_->context());
  core_->add_channel("mine", tcp);
  EXPECT_EQ(&core_->channel("mine"), tcp.get());
}

TEST_F(CoreTest, RemembersWhatDiscoveryHasFound) {
  core_->found_urls().add({"rr+tcp://10.0.0.1:2355/?service=s"});
  EXPECT_TRUE(core_->found_urls().contains(Url::parse("rr+tcp://10.0.0.1:2355/?service=s")));
  EXPECT_GT(core_->clock().now(), 0);
}

class Attending final : public Attended {
 public:
  void attend(channel::Time now) override {
    if (!was_attended.exchange(true)) attended.set_value(now);
  }
  std::atomic<bool> was_attended{false};
  std::promise<channel::Time> attended;
};

TEST_F(CoreTest, LooksAfterItsEndpoints) {
  NodeOptions quick = options();
  quick.keep_alive_period = 40ms;
  const auto core = make(std::move(quick));
  core->start();
  const auto begin = channel::Clock::now();
  const auto endpoint = std::make_shared<Attending>();
  core->attend(endpoint);
  EXPECT_GE(endpoint->attended.get_future().get(), begin);
}

TEST_F(CoreTest, CallsFunctionsInTime) {
  std::promise<void> once;
  auto after = core_->after(1ms, [&] { once.set_value(); });
  once.get_future().get();
  std::promise<void> third;
  std::atomic<int> calls{0};
  auto every = core_->every(1ms, [&] {
    if (++calls == 3) third.set_value();
  });
  third.get_future().get();
  EXPECT_EQ(failure([&] { auto timer = core_->every(0ms, [] {}); }), ErrorCode::invalid_argument);
  EXPECT_EQ(failure([&] { auto timer = core_->after(1ms, nullptr); }), ErrorCode::invalid_argument);
}

TEST_F(CoreTest, ATimerThatIsCancelledIsNotCalled) {
  core_->start();
  const auto reactor = core_->context().reactor;
  std::atomic<int> calls{0};
  const auto timer = std::make_shared<Timer::State>(
      reactor,
      Timer::State::Terms{.delay = 1h, .period = 0ms, .work = [&] { ++calls; }, .report = nullptr});
  timer->start();
  EXPECT_TRUE(timer->is_running());
  timer->cancel();
  EXPECT_FALSE(timer->is_running());
  EXPECT_EQ(calls, 0);
  std::promise<std::string> reported;
  const auto throwing = std::make_shared<Timer::State>(
      reactor,
      Timer::State::Terms{
          .delay = 0ms,
          .period = 0ms,
          .work = [] { throw std::runtime_error("why"); },
          .report = [&](std::string_view text) { reported.set_value(std::string(text)); }});
  throwing->start();
  EXPECT_THAT(reported.get_future().get(), HasSubstr("why"));
  EXPECT_FALSE(throwing->is_running());
}

TEST_F(CoreTest, WhatUserCodeThrowsIsLogged) {
  EXPECT_TRUE(call_user_code(*core_, "a function", [] {}));
  EXPECT_FALSE(call_user_code(*core_, "a function", [] { throw std::runtime_error("why"); }));
  EXPECT_THAT(lines(), Contains(HasSubstr("a function has thrown: why")));
  EXPECT_FALSE(call_user_code(*core_, "a function", "of pipe", [] { throw 7; }));
  EXPECT_THAT(lines(), Contains(HasSubstr("a function `of pipe` has thrown: ")));
  EXPECT_TRUE(call_user_code(*core_, "a function", "of pipe", [] {}));
  core_->log(LogLevel::info, "a line");
  EXPECT_THAT(lines(), Contains("a line"));
  try {
    throw Error(ErrorCode::service_error, "of the service");
  } catch (...) {
    EXPECT_THAT(text_of_current_exception(), HasSubstr("of the service"));
  }
}

}  // namespace
}  // namespace rr::endpoint
