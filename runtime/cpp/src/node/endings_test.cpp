// SPDX-License-Identifier: Apache-2.0
// How nodes, services and sessions end, whoever ends them, and what happens to what is left.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <boost/asio/use_future.hpp>
#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "rr/call.hpp"
#include "runtime/cpp/src/node/testing/async_counter.hpp"
#include "runtime/cpp/src/node/testing/gated_counter.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using boost::asio::use_future;
using Clock = std::chrono::steady_clock;

// reset() does what the test wants, in the handler.
class ScriptedCounter : public Counter {
 public:
  void reset() override { script(); }
  std::function<void()> script;
};

// reset() waits for the test.
// Does something when it is destroyed.
std::shared_ptr<void> at_end(std::function<void()> what) {
  return {nullptr, [what = std::move(what)](void*) { what(); }};
}

TEST(Shutdown, WaitsForAHandlerThatRuns) {
  const auto object = std::make_shared<GatedCounter>();
  Pair pair({}, {}, object);
  auto counter = pair.connect();
  auto call = std::async(std::launch::async, [&] { error_of([&] { counter->reset(); }); });
  EXPECT_TRUE(object->gate.has_entered());
  auto end = std::async(std::launch::async, [&] {
    pair.server.shutdown();
    return object->is_done.load();
  });
  EXPECT_EQ(end.wait_for(50ms), std::future_status::timeout);
  object->gate.open();
  EXPECT_TRUE(end.get());
  call.get();
}

TEST(Shutdown, OfTwoThreadsBothWait) {
  const auto object = std::make_shared<GatedCounter>();
  Pair pair({}, {}, object);
  auto counter = pair.connect();
  auto call = std::async(std::launch::async, [&] { error_of([&] { counter->reset(); }); });
  EXPECT_TRUE(object->gate.has_entered());
  const auto end = [&] {
    pair.server.shutdown();
    return object->is_done.load();
  };
  auto first = std::async(std::launch::async, end);
  auto second = std::async(std::launch::async, end);
  EXPECT_EQ(first.wait_for(30ms), std::future_status::timeout);
  EXPECT_EQ(second.wait_for(30ms), std::future_status::timeout);
  object->gate.open();
  EXPECT_TRUE(first.get());
  EXPECT_TRUE(second.get());
  call.get();
}

TEST(Shutdown, MayBeStartedByAHandler) {
  const auto object = std::make_shared<ScriptedCounter>();
  Pair pair({}, {}, object);
  auto counter = pair.connect();
  Gate gate;
  object->script = [&] {
    pair.server.shutdown();
    gate.pass();
  };
  auto call =
      std::async(std::launch::async, [&] { return error_of([&] { counter->reset(); }).code(); });
  EXPECT_TRUE(gate.has_entered());  // it did not wait for itself
  EXPECT_EQ(call.get(), ErrorCode::connection_error);
  EXPECT_EQ(error_of([&] { pair.server.run_aside([] {}); }).code(), ErrorCode::invalid_operation);
  EXPECT_EQ(error_of([&] { pair.server.listen_tcp(0); }).code(), ErrorCode::invalid_operation);
  auto rest = std::async(std::launch::async, [&] { pair.server.shutdown(); });
  EXPECT_EQ(rest.wait_for(30ms), std::future_status::timeout);  // the handler still runs
  gate.open();
  rest.get();
}

TEST(Shutdown, MayBeStartedByACompletion) {
  std::promise<double> promise;
  Pair pair;
  auto counter = pair.connect();
  counter->async_add(1, 2, [&](const std::exception_ptr&, double sum) {
    pair.client.shutdown();
    promise.set_value(sum);
  });
  EXPECT_EQ(promise.get_future().get(), 3);
  EXPECT_TRUE(eventually([&] { return !counter.is_open(); }));
}

TEST(Shutdown, MayBeStartedAside) {
  std::promise<void> promise;
  Pair pair;
  auto counter = pair.connect();
  pair.client.run_aside([&] {
    pair.client.shutdown();
    promise.set_value();
  });
  promise.get_future().get();
  EXPECT_FALSE(counter.is_open());
}

TEST(Shutdown, AHandlerMayDestroyItsNode) {
  auto object = std::make_shared<ScriptedCounter>();
  const std::weak_ptr<ScriptedCounter> watch = object;
  auto server = std::make_unique<Node>();
  server->register_service("counter", object);
  const std::uint16_t port = server->listen_tcp(0, "127.0.0.1");
  std::promise<void> destroyed;
  object->script = [&] {
    server.reset();
    destroyed.set_value();
  };
  object.reset();
  Node client;
  auto counter = client.connect<CounterStub>("rr+tcp://127.0.0.1:" + std::to_string(port) +
                                             "/?service=counter");
  EXPECT_EQ(error_of([&] { counter->reset(); }).code(), ErrorCode::connection_error);
  destroyed.get_future().get();
  EXPECT_TRUE(eventually([&] { return watch.expired(); }));
}

TEST(Shutdown, WorkAsideMayDestroyItsNode) {
  std::promise<void> destroyed;
  Pair pair;
  auto client = std::make_unique<Node>(with_channel({}));
  auto other = client->async_connect<CounterStub>(pair.url());
  auto counter = client->connect<CounterStub>(pair.url());
  client->run_aside([&] {
    client.reset();
    destroyed.set_value();
  });
  destroyed.get_future().get();
  EXPECT_FALSE(counter.is_open());
  // Whether it was in time or not, it comes to an end.
  error_of([&] { other.get(); });
}

TEST(Shutdown, WorkAsideIsWaitedForAndRefusedAfterwards) {
  Gate gate;  // threads of the node may still be in there when it ends
  Pair pair;
  std::atomic<bool> is_done{false};
  std::thread::id thread;
  pair.client.run_aside([&] {
    thread = std::this_thread::get_id();
    gate.pass();
    is_done = true;
  });
  EXPECT_TRUE(gate.has_entered());
  auto end = std::async(std::launch::async, [&] {
    pair.client.shutdown();
    return is_done.load();
  });
  EXPECT_EQ(end.wait_for(30ms), std::future_status::timeout);
  gate.open();
  EXPECT_TRUE(end.get());
  EXPECT_NE(thread, std::this_thread::get_id());
  EXPECT_EQ(error_of([&] { pair.client.run_aside([] {}); }).code(), ErrorCode::invalid_operation);
}

TEST(Shutdown, WhatWorkAsideOwnsMayUseTheNodeWhenItGoes) {
  Gate gate;  // threads of the node may still be in there when it ends
  Pair pair;
  pair.client.run_aside([owner = at_end([&] {
                           gate.pass();
                           EXPECT_THAT(pair.client.urls("counter"), ::testing::IsEmpty());
                         })] {});
  EXPECT_TRUE(gate.has_entered());
  auto next = std::async(std::launch::async, [&] { pair.client.run_aside([] {}); });
  EXPECT_EQ(next.wait_for(5s), std::future_status::ready);  // does not wait for the first
  gate.open();
  next.get();
}

TEST(Shutdown, CompletionsThatAreLeftRunOnAThreadOfTheNodeBeforeItReturns) {
  const auto object = std::make_shared<GatedCounter>();
  Pair pair({}, {}, object);
  auto counter = pair.connect();
  auto blocker = std::async(std::launch::async, [&] { error_of([&] { counter->reset(); }); });
  EXPECT_TRUE(object->gate.has_entered());
  constexpr int calls = 50;
  std::atomic<int> ended{0};
  std::atomic<int> inside{0};
  const auto caller = std::this_thread::get_id();
  for (int i = 0; i < calls; ++i) {
    counter->async_add(i, 1, [&, i](const std::exception_ptr& error, double) {
      if (i == 0) std::this_thread::sleep_for(20ms);
      if (std::this_thread::get_id() == caller) ++inside;
      EXPECT_EQ(code_of(error), ErrorCode::connection_error);
      ++ended;
    });
  }
  pair.client.shutdown();
  EXPECT_EQ(ended, calls);
  EXPECT_EQ(inside, 0);
  object->gate.open();
  blocker.get();
}

TEST(Shutdown, ACallThatIsStartedAfterwardsFailsOnAnotherThread) {
  std::promise<std::pair<ErrorCode, std::thread::id>> promise;
  Pair pair;
  const auto stub = pair.connect().stub();
  pair.client.shutdown();
  stub->async_add(1, 2, [&](const std::exception_ptr& error, double) {
    promise.set_value({code_of(error), std::this_thread::get_id()});
  });
  const auto [code, thread] = promise.get_future().get();
  EXPECT_EQ(code, ErrorCode::invalid_operation);
  EXPECT_NE(thread, std::this_thread::get_id());
}

TEST(Shutdown, ALateCompletionMayOwnAllThatIsLeft) {
  std::promise<void> done;
  {
    std::shared_ptr<CounterStub> stub;
    {
      Pair pair;
      stub = pair.connect().stub();
    }
    CounterStub& counter = *stub;
    counter.async_add(1, 2, [owner = std::move(stub), &done](const std::exception_ptr&, double) {
      done.set_value();
    });
  }
  done.get_future().get();
}

TEST(Shutdown, EveryCompletionIsCalledWhateverReadsMeanwhile) {
  for (int round = 0; round < 10; ++round) {
    Pair pair;
    auto counter = pair.connect();
    const auto& stub = counter.stub();
    std::vector<std::thread> callers;
    for (int t = 0; t < 3; ++t) {
      callers.emplace_back([&] {
        while (error_of([&] { stub->add(1, 2); }).code() == ErrorCode::none) {
        }
      });
    }
    std::atomic<int> ended{0};
    int started = 0;
    const auto until = Clock::now() + 3ms;
    auto end = std::async(std::launch::async, [&] {
      std::this_thread::sleep_for(1ms);
      pair.client.shutdown();
    });
    while (Clock::now() < until) {
      ++started;
      stub->async_add(1, 2, [&](const std::exception_ptr&, double) { ++ended; });
    }
    for (std::thread& caller : callers) caller.join();
    end.get();
    EXPECT_TRUE(eventually([&] { return ended == started; })) << ended << " of " << started;
  }
}

TEST(Ownership, AHandlerMayOwnTheLastReferenceToItsStub) {
  Pair pair;
  auto counter = pair.connect();
  std::weak_ptr<CounterStub> watch;
  {
    const auto child = counter->get_child();
    watch = child;
    child->ticked().connect([child](std::int32_t, const std::string&) {}).detach();
  }
  EXPECT_FALSE(watch.expired());
  auto end = std::async(std::launch::async, [&] { counter.close(); });
  EXPECT_EQ(end.wait_for(10s), std::future_status::ready);
  EXPECT_TRUE(eventually([&] { return watch.expired(); }));
}

TEST(Ownership, ADisconnectedHandlerLetsGoOfWhatItOwns) {
  Pair pair;
  auto counter = pair.connect();
  auto child = counter->get_child();
  const std::weak_ptr<CounterStub> watch = child;
  auto subscription = child->ticked().connect([child](std::int32_t, const std::string&) {});
  child.reset();
  auto next = std::async(std::launch::async, [&] {
    subscription.disconnect();
    counter->ticked().connect([](std::int32_t, const std::string&) {}).detach();
  });
  EXPECT_EQ(next.wait_for(10s), std::future_status::ready);
  EXPECT_TRUE(watch.expired());
}

TEST(Ownership, AHandlerMayDisconnectItselfAndOwnItsStub) {
  std::promise<std::int32_t> got;
  Pair pair;
  auto counter = pair.connect();
  auto child = counter->get_child();
  const std::weak_ptr<CounterStub> watch = child;
  Subscription subscription;
  subscription = child->ticked().connect(
      [&, child, text = std::string(100, 'x')](std::int32_t count, const std::string&) {
        subscription.disconnect();
        got.set_value(count + static_cast<std::int32_t>(text.size()));
      });
  child->fire(2);
  EXPECT_EQ(got.get_future().get(), 100);
  child.reset();
  EXPECT_TRUE(eventually([&] { return watch.expired(); }));
}

TEST(Ownership, AnObjectMayUseItsNodeWhenItGoes) {
  class Departing : public Counter {
   public:
    explicit Departing(Node& node) : node_(node) {}
    ~Departing() override { node_.register_service("heir", std::make_shared<Counter>("heir")); }
    void rr_attached(ServiceContext& context, const std::string& /*path*/) override {
      service = &context;
    }
    ServiceContext* service = nullptr;

   private:
    Node& node_;
  };
  Pair pair;
  auto object = std::make_shared<Departing>(pair.server);
  pair.server.register_service("departing", object);
  ServiceContext& service = *object->service;
  object.reset();
  auto end = std::async(std::launch::async, [&] { service.close(); });
  EXPECT_EQ(end.wait_for(10s), std::future_status::ready);
  EXPECT_EQ(pair.client.connect<CounterStub>(pair.url("heir"))->get_name(), "heir");
}

TEST(Ownership, AnObjectThatOwesAnAnswerGoesWithItsNode) {
  class Owing : public Counter {
   public:
    void slow(Reply<void> reply, std::int32_t /*milliseconds*/) override {
      reply_ = std::make_unique<Reply<void>>(std::move(reply));
    }

   private:
    std::unique_ptr<Reply<void>> reply_;
  };
  auto object = std::make_shared<Owing>();
  const std::weak_ptr<Owing> watch = object;
  {
    Pair pair({}, {}, std::move(object));
    auto counter = pair.connect();
    with_options(within(50ms), [&] {
      EXPECT_EQ(error_of([&] { counter->slow(0); }).code(), ErrorCode::request_timeout);
    });
    EXPECT_FALSE(watch.expired());
  }
  EXPECT_TRUE(watch.expired());
}

TEST(Ownership, AServiceWhoseObjectRefusesIsNotOffered) {
  class Refusing : public Counter {
   public:
    void rr_attached(ServiceContext& /*context*/, const std::string& /*path*/) override {
      throw Error(ErrorCode::invalid_operation, "not ready");
    }
  };
  Pair pair;
  const auto add = [&](std::shared_ptr<Counter> object) {
    return error_of([&] { pair.server.register_service("spare", std::move(object)); }).message();
  };
  EXPECT_EQ(add(std::make_shared<Refusing>()), "not ready");
  EXPECT_EQ(error_of([&] { pair.client.connect<CounterStub>(pair.url("spare")); }).code(),
            ErrorCode::service_not_found);
  EXPECT_EQ(add(std::make_shared<Counter>("spare")), "");
  EXPECT_EQ(pair.client.connect<CounterStub>(pair.url("spare"))->get_name(), "spare");
}

TEST(Ownership, AServiceIsOfferedWhenItsObjectIsAttached) {
  class Slow : public Counter {
   public:
    explicit Slow(Gate& gate) : gate_(gate) {}
    void rr_attached(ServiceContext& /*context*/, const std::string& /*path*/) override {
      gate_.pass();
      set_value(1);
    }

   private:
    Gate& gate_;
  };
  Gate gate;  // threads of the node may still be in there when it ends
  Pair pair;
  auto registration = std::async(std::launch::async, [&] {
    pair.server.register_service("slow", std::make_shared<Slow>(gate));
  });
  EXPECT_TRUE(gate.has_entered());
  EXPECT_EQ(error_of([&] { pair.client.connect<CounterStub>(pair.url("slow")); }).code(),
            ErrorCode::service_not_found);
  gate.open();
  registration.get();
  EXPECT_EQ(pair.client.connect<CounterStub>(pair.url("slow"))->get_value(), 1);
}

TEST(Ownership, AServiceMayBeClosedByAHandler) {
  class Closing : public Counter {
   public:
    void rr_attached(ServiceContext& context, const std::string& /*path*/) override {
      service = &context;
    }
    void reset() override { service->close(); }
    ServiceContext* service = nullptr;
  };
  std::promise<ErrorCode> why;
  Pair pair;
  pair.server.register_service("closing", std::make_shared<Closing>());
  ConnectOptions options;
  options.on_closed = [&](const Error& error) { why.set_value(error.code()); };
  auto counter = pair.client.connect<CounterStub>(pair.url("closing"), options);
  const ErrorCode code = error_of([&] { counter->reset(); }).code();
  // The answer and the farewell follow each other; whichever is handled first.
  EXPECT_TRUE(code == ErrorCode::none || code == ErrorCode::connection_error);
  EXPECT_EQ(why.get_future().get(), ErrorCode::service_not_found);
  pair.server.register_service("closing", std::make_shared<Counter>("next"));
  EXPECT_EQ(pair.client.connect<CounterStub>(pair.url("closing"))->get_name(), "next");
}

// Who has gone, on which thread, and whether a request still ran.
struct Leaving {
  const std::shared_ptr<GatedCounter> object = std::make_shared<GatedCounter>();
  std::promise<std::pair<std::thread::id, bool>> gone;

  ServiceOptions options() {
    ServiceOptions result;
    result.on_client_disconnected = [this](const ServiceClient&) {
      gone.set_value({std::this_thread::get_id(), object->is_done});
    };
    return result;
  }
};

class EndsOfSessions
    : public ::testing::TestWithParam<std::pair<const char*, std::function<void(Pair&)>>> {};
INSTANTIATE_TEST_SUITE_P(
    Shutdown, EndsOfSessions,
    ::testing::Values(std::make_pair("Disconnect",
                                     [](Pair& pair) {
                                       pair.service->disconnect(
                                           pair.service->clients().front().endpoint);
                                     }),
                      std::make_pair("Close", [](Pair& pair) { pair.service->close(); }),
                      std::make_pair("ClientShutdown", [](Pair& pair) { pair.client.shutdown(); }),
                      std::make_pair("Shutdown", [](Pair& pair) { pair.server.shutdown(); })),
    [](const auto& test) { return std::string(test.param.first); });

TEST_P(EndsOfSessions, AreToldOnAThreadOfTheNodeBehindTheLastRequest) {
  Leaving leaving;
  std::promise<std::thread::id> ender;
  Pair pair({}, {}, leaving.object, leaving.options());
  auto counter = pair.connect();
  auto call = std::async(std::launch::async, [&] { error_of([&] { counter->reset(); }); });
  EXPECT_TRUE(leaving.object->gate.has_entered());
  auto end = std::async(std::launch::async, [&] {
    ender.set_value(std::this_thread::get_id());
    GetParam().second(pair);
  });
  auto gone = leaving.gone.get_future();
  EXPECT_EQ(gone.wait_for(50ms), std::future_status::timeout);
  leaving.object->gate.open();
  const auto [thread, was_done] = gone.get();
  EXPECT_TRUE(was_done);
  EXPECT_NE(thread, ender.get_future().get());
  EXPECT_NE(thread, std::this_thread::get_id());
  end.get();
  call.get();
}

// How long close() takes when the service is busy and does not answer the farewell.
std::chrono::nanoseconds time_to_close(const CallOptions& options) {
  const auto object = std::make_shared<GatedCounter>();
  Pair pair({}, {}, object);
  auto counter = pair.connect();
  auto call = std::async(std::launch::async, [&] { error_of([&] { counter->reset(); }); });
  EXPECT_TRUE(object->gate.has_entered());
  const auto begin = Clock::now();
  with_options(options, [&] { counter.close(); });
  const auto took = Clock::now() - begin;
  object->gate.open();
  call.get();
  return took;
}

TEST(Sessions, ClosingIsNotSubjectToTheOptionsOfCalls) {
  std::stop_source stop;
  stop.request_stop();
  auto endless = std::async(std::launch::async,
                            [] { return time_to_close(within(std::chrono::milliseconds::max())); });
  auto cancelled =
      std::async(std::launch::async, [&] { return time_to_close(stopped_by(stop.get_token())); });
  auto brief = std::async(std::launch::async, [] { return time_to_close(within(1ms)); });
  for (auto* const took : {&endless, &cancelled, &brief}) {
    ASSERT_EQ(took->wait_for(20s), std::future_status::ready);
    EXPECT_GE(took->get(), 450ms);
  }
}

TEST(Subscriptions, WaitForAHandlerThatRunsWhenTheyEnd) {
  Pair pair;
  auto counter = pair.connect();
  Gate gate;
  std::atomic<bool> is_done{false};
  auto subscription = std::make_unique<Subscription>(
      counter->ticked().connect([&](std::int32_t, const std::string&) {
        gate.pass();
        is_done = true;
      }));
  counter->fire(1);
  EXPECT_TRUE(gate.has_entered());
  auto end = std::async(std::launch::async, [&] {
    subscription.reset();
    return is_done.load();
  });
  EXPECT_EQ(end.wait_for(30ms), std::future_status::timeout);
  gate.open();
  EXPECT_TRUE(end.get());
}

TEST(Subscriptions, OfAStubThatEndsAreWaitedFor) {
  Pair pair;
  auto counter = pair.connect();
  auto child = counter->get_child();
  Gate gate;
  std::atomic<bool> is_done{false};
  child->ticked()
      .connect([&](std::int32_t, const std::string&) {
        gate.pass();
        is_done = true;
      })
      .detach();
  child->fire(1);
  EXPECT_TRUE(gate.has_entered());
  auto end = std::async(std::launch::async, [&] {
    child.reset();
    return is_done.load();
  });
  EXPECT_EQ(end.wait_for(30ms), std::future_status::timeout);
  gate.open();
  EXPECT_TRUE(end.get());
}

}  // namespace
}  // namespace rr::testing
