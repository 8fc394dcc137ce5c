// SPDX-License-Identifier: Apache-2.0
// Object references, events and what a service tells its clients.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <future>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "runtime/cpp/src/node/testing/gate.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""ms;

TEST(Objects, AnObjrefLeadsToAnotherObject) {
  Pair pair;
  auto counter = pair.connect();
  const auto child = counter->get_child();
  EXPECT_EQ(child->get_name(), "child");
  EXPECT_EQ(child->rr_path(), "counter.child");
  child->set_value(5);
  EXPECT_EQ(counter->get_value(), 0);
  EXPECT_EQ(child->get_child()->get_child()->rr_path(), "counter.child.child.child");
}

TEST(Objects, OnePathIsOneObjectAndOneStub) {
  Pair pair;
  auto counter = pair.connect();
  const auto child = counter->get_by_number(7);
  child->set_value(5);
  EXPECT_EQ(counter->get_by_number(7), child);
  EXPECT_EQ(counter->get_by_number(8)->get_value(), 0);
  auto other = pair.connect();
  EXPECT_EQ(other->get_by_number(7)->get_value(), 5);
}

TEST(Objects, IndexesTravelWhateverTheirBytes) {
  Pair pair;
  auto counter = pair.connect();
  EXPECT_EQ(counter->get_by_number(-3)->get_name(), "number -3");
  EXPECT_EQ(counter->get_by_number(-3)->rr_path(), "counter.by_number[%2d3]");
  for (const std::string index : {"left", "a b.c/_Z1", "a.b[c]%/", "\xc3\xa9", "]"}) {
    EXPECT_EQ(counter->get_by_name(index)->get_name(), "name " + index);
  }
  EXPECT_EQ(counter->get_by_name("a b.c/_Z1")->rr_path(), "counter.by_name[a%20b%2ec%2f%5fZ1]");
}

TEST(Objects, ANumberIsOneIndexHoweverItIsSpelled) {
  Pair pair;
  auto counter = pair.connect();
  EXPECT_EQ(counter.find_object_type("counter.by_number[7]"), "test.counter.Counter");
  EXPECT_EQ(counter.find_object_type("counter.by_number[007]"), "test.counter.Counter");
  pair.service->release_path("counter.by_number[7]");
  EXPECT_EQ(error_of([&] { pair.service->release_path("counter.by_number[007]"); }).code(),
            ErrorCode::service_error);
  EXPECT_EQ(counter.find_object_type("counter.by_name[007]"), "test.counter.Counter");
  pair.service->release_path("counter.by_name[007]");
}

TEST(Objects, WhatTheServiceThrowsAtAnObjrefArrives) {
  Pair pair;
  auto counter = pair.connect();
  const Error thrown = error_of([&] { counter->get_by_number(99); });
  EXPECT_EQ(thrown.code(), ErrorCode::invalid_argument);
  EXPECT_EQ(thrown.message(), "no object with index 99");
  EXPECT_EQ(error_of([&] { counter->get_by_name("null"); }).code(), ErrorCode::service_error);
}

TEST(Objects, AVarobjectHasTheClassThatTheServiceTells) {
  Pair pair;
  auto counter = pair.connect();
  const auto anything = std::dynamic_pointer_cast<CounterStub>(counter->get_anything());
  ASSERT_TRUE(anything);
  EXPECT_EQ(anything->get_name(), "child");
  EXPECT_EQ(counter.find_object_type("counter.child"), "test.counter.Counter");
}

TEST(Objects, ARootCanBeTakenAsWhatItImplements) {
  Pair pair;
  auto named = pair.client.connect<NamedStub>(pair.url());
  EXPECT_EQ(named->get_name(), "root");
  EXPECT_EQ(named.object_type(), "test.counter.Counter");
  pair.client.add_definition(rr_definition);
  auto any = pair.client.connect<Stub>(pair.url());
  EXPECT_EQ(any->rr_object_type().name, "test.counter.Counter");
  ConnectOptions wrong;
  wrong.object_type = "test.counter.Other";
  EXPECT_EQ(error_of([&] { pair.client.connect<Stub>(pair.url(), wrong); }).code(),
            ErrorCode::service_error);
}

TEST(Objects, AnUnknownTypeIsRefused) {
  Pair pair;
  EXPECT_EQ(error_of([&] { pair.client.connect<Stub>(pair.url()); }).code(),
            ErrorCode::service_error);
}

TEST(Objects, AReleasedPathIsFoundAnew) {
  std::promise<std::string> released;
  Pair pair;
  ConnectOptions options;
  options.on_path_released = [&](const std::string& path) { released.set_value(path); };
  auto counter = pair.connect(options);
  const auto old = counter->get_by_name("left");
  const auto below = old->get_child();
  old->set_value(3);
  pair.service->release_path("counter.by_name[left]");
  EXPECT_EQ(released.get_future().get(), "counter.by_name[left]");
  EXPECT_EQ(old->get_value(), 0);  // the object that is there now
  const auto fresh = counter->get_by_name("left");
  EXPECT_NE(fresh, old);
  EXPECT_NE(fresh->get_child(), below);
  EXPECT_EQ(error_of([&] { pair.service->release_path("counter.by_name[right]"); }).code(),
            ErrorCode::service_error);
  EXPECT_EQ(error_of([&] { pair.service->release_path("counter"); }).code(),
            ErrorCode::invalid_operation);
}

// The notice waits for a handler of the program; the answer that comes behind it is read at once.
TEST(Objects, AReleasedPathIsFoundAnewBeforeTheReleaseIsTold) {
  Gate gate;
  std::promise<void> released;
  Pair pair;
  ConnectOptions options;
  options.on_path_released = [&](const std::string&) { released.set_value(); };
  auto counter = pair.connect(options);
  const auto old = counter->get_by_name("left");
  const Subscription holding =
      counter->ticked().connect([&](std::int32_t, const std::string&) { gate.pass(); });
  pair.object->rr_fire_ticked(1, "");
  ASSERT_TRUE(gate.has_entered());
  pair.service->release_path("counter.by_name[left]");
  EXPECT_EQ(counter->get_value(), 0);  // an answer that was sent behind the notice
  const auto fresh = counter->get_by_name("left");
  EXPECT_NE(fresh, old);
  gate.open();
  released.get_future().get();
  EXPECT_EQ(counter->get_by_name("left"), fresh);
}

// An object of a class of its own, which a Counter implements.
class OnlyNamed final : public Skeleton {
 public:
  [[nodiscard]] const ObjectType& rr_object_type() const override { return rr_Named; }
  void rr_dispatch(std::size_t /*member*/, Request& request) override {
    const std::string name = "only named";
    request.answer(&name);
  }
  std::shared_ptr<Skeleton> rr_child(std::size_t /*member*/, const ObjectIndex&) override {
    return nullptr;
  }
};

// Each `reset` puts an object of the other class where `anything` leads.
class Changing final : public Counter {
 public:
  void rr_attached(ServiceContext& context, const std::string& /*path*/) override {
    context_ = &context;
  }
  void reset() override {
    is_counter_ = !is_counter_;
    context_->release_path("counter.anything");
  }
  std::shared_ptr<Skeleton> get_anything() override {
    if (is_counter_) return std::make_shared<Counter>("a counter");
    return std::make_shared<OnlyNamed>();
  }

 private:
  ServiceContext* context_ = nullptr;
  bool is_counter_ = false;
};

// `./check --long` does it 100,000 times.
TEST(Objects, AVarobjectThatIsReplacedHasTheClassOfTheNewOne) {
  const char* const given = std::getenv("ROBDEF_VAROBJECT_LOOPS");
  const int loops = given == nullptr ? 500 : std::atoi(given);
  Pair pair({}, {}, std::make_shared<Changing>());
  auto counter = pair.connect();
  std::shared_ptr<Stub> found = counter->get_anything();
  int wrong = 0;
  for (int i = 0; i < loops; ++i) {
    counter->reset();
    found = counter->get_anything();
    const bool is_counter = found->rr_object_type().name == "test.counter.Counter";
    if (is_counter != (i % 2 == 0)) ++wrong;
    if (const auto stub = std::dynamic_pointer_cast<CounterStub>(found)) {
      EXPECT_EQ(stub->get_value(), 0);
    }
  }
  EXPECT_EQ(wrong, 0) << "of " << loops;
}

TEST(Objects, AnObjectIsAttachedBeforeItIsUsed) {
  class Attached : public Counter {
   public:
    using Counter::Counter;
    void rr_attached(ServiceContext& context, const std::string& path) override {
      where = context.name() + " at " + path;
    }
    std::string echo(const std::string& /*text*/) override { return where; }
    std::shared_ptr<Skeleton> get_child() override { return std::make_shared<Attached>("child"); }
    std::string where;
  };
  Pair pair({}, {}, std::make_shared<Attached>());
  auto counter = pair.connect();
  EXPECT_EQ(counter->echo(""), "counter at counter");
  EXPECT_EQ(counter->get_child()->echo(""), "counter at counter.child");
}

// What events have brought.
struct Ticks {
  std::mutex mutex;
  std::vector<std::pair<std::int32_t, std::string>> seen;

  auto handler() {
    return [this](std::int32_t count, const std::string& text) {
      const std::lock_guard lock(mutex);
      seen.emplace_back(count, text);
    };
  }
  std::size_t size() {
    const std::lock_guard lock(mutex);
    return seen.size();
  }
};

TEST(Events, ReachEveryClientInOrder) {
  Pair pair;
  auto first = pair.connect();
  auto second = pair.connect();
  Ticks ticks;
  Ticks others;
  auto subscription = first->ticked().connect(ticks.handler());
  auto other_subscription = second->ticked().connect(others.handler());
  first->fire(3);
  EXPECT_TRUE(eventually([&] { return ticks.size() == 3 && others.size() == 3; }));
  for (std::int32_t i = 0; i < 3; ++i) {
    EXPECT_EQ(ticks.seen[static_cast<std::size_t>(i)], std::make_pair(i, std::string("root")));
  }
  second.close();
  first->fire(1);
  EXPECT_TRUE(eventually([&] { return ticks.size() == 4; }));
  EXPECT_EQ(others.size(), 3U);
}

TEST(Events, ComeOfTheObjectTheyAreAskedFrom) {
  Pair pair;
  auto counter = pair.connect();
  const auto child = counter->get_child();
  Ticks root_ticks;
  Ticks child_ticks;
  auto a = counter->ticked().connect(root_ticks.handler());
  auto b = child->ticked().connect(child_ticks.handler());
  child->fire(2);
  EXPECT_TRUE(eventually([&] { return child_ticks.size() == 2; }));
  EXPECT_EQ(root_ticks.size(), 0U);
}

TEST(Events, StopWhenTheSubscriptionEnds) {
  Pair pair;
  auto counter = pair.connect();
  Ticks ticks;
  Ticks rest;
  auto kept = counter->ticked().connect(rest.handler());
  {
    auto subscription = counter->ticked().connect(ticks.handler());
    counter->fire(1);
    EXPECT_TRUE(eventually([&] { return ticks.size() == 1; }));
  }
  counter->fire(1);
  EXPECT_TRUE(eventually([&] { return rest.size() == 2; }));
  EXPECT_EQ(ticks.size(), 1U);
}

TEST(Events, ADetachedHandlerStaysWithTheStub) {
  Pair pair;
  auto counter = pair.connect();
  Ticks ticks;
  counter->ticked().connect(ticks.handler()).detach();
  counter->fire(2);
  EXPECT_TRUE(eventually([&] { return ticks.size() == 2; }));
}

TEST(Events, AHandlerMayCallAndDisconnectItself) {
  std::promise<double> result;
  Pair pair;
  auto counter = pair.connect();
  Subscription subscription;
  subscription = counter->ticked().connect([&](std::int32_t, const std::string&) {
    subscription.disconnect();
    result.set_value(counter->add(1, 2));
  });
  counter->fire(3);
  EXPECT_EQ(result.get_future().get(), 3);
}

TEST(Events, AreHandledOnAThreadOfTheNodeOutsideOfCalls) {
  Pair pair;
  auto counter = pair.connect();
  std::mutex mutex;
  std::vector<std::thread::id> threads;
  auto subscription = counter->ticked().connect([&](std::int32_t, const std::string&) {
    const std::lock_guard lock(mutex);
    threads.push_back(std::this_thread::get_id());
  });
  for (int i = 0; i < 50; ++i) counter->fire(1);  // the calls read the events
  EXPECT_TRUE(eventually([&] {
    const std::lock_guard lock(mutex);
    return threads.size() == 50;
  }));
  EXPECT_THAT(threads, ::testing::Each(::testing::Ne(std::this_thread::get_id())));
}

TEST(Events, ASlowHandlerDoesNotHoldUpCalls) {
  std::promise<void> entered;
  std::promise<void> gate;
  Pair pair;
  auto counter = pair.connect();
  auto opened = gate.get_future().share();
  std::atomic<int> count{0};
  auto subscription = counter->ticked().connect([&](std::int32_t, const std::string&) {
    if (count++ == 0) entered.set_value();
    opened.wait();
  });
  counter->fire(2);
  entered.get_future().wait();
  for (int i = 0; i < 20; ++i) EXPECT_EQ(counter->add(i, 1), i + 1);
  EXPECT_EQ(count, 1);  // one at a time
  gate.set_value();
  EXPECT_TRUE(eventually([&] { return count == 2; }));
}

TEST(Events, AHandlerThatThrowsIsLoggedAndTheNextEventComes) {
  std::mutex mutex;
  std::vector<std::string> log;
  NodeOptions options;
  options.log = [&](LogLevel, std::string_view text) {
    const std::lock_guard lock(mutex);
    log.emplace_back(text);
  };
  {
    Pair pair({}, options);
    auto counter = pair.connect();
    std::atomic<int> count{0};
    auto subscription = counter->ticked().connect([&](std::int32_t, const std::string&) {
      ++count;
      throw std::runtime_error("broken handler");
    });
    counter->fire(2);
    EXPECT_TRUE(eventually([&] { return count == 2; }));
  }
  EXPECT_THAT(log, ::testing::Contains(::testing::HasSubstr("broken handler")));
}

TEST(Events, ArriveSoonAfterManyCalls) {
  Pair pair;
  auto counter = pair.connect();
  Ticks ticks;
  auto subscription = counter->ticked().connect(ticks.handler());
  for (int i = 0; i < 200; ++i) counter->add(1, 2);  // the socket is parked now
  pair.object->fire(1);
  EXPECT_TRUE(eventually([&] { return ticks.size() == 1; }));
}

TEST(Events, OfManyThreadsAllArrive) {
  Pair pair;
  auto counter = pair.connect();
  Ticks ticks;
  auto subscription = counter->ticked().connect(ticks.handler());
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) threads.emplace_back([&] { pair.object->fire(100); });
  for (int i = 0; i < 200; ++i) counter->add(1, 2);
  for (std::thread& thread : threads) thread.join();
  EXPECT_TRUE(eventually([&] { return ticks.size() == 400; }));
}

}  // namespace
}  // namespace rr::testing
