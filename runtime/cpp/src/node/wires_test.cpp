// SPDX-License-Identifier: Apache-2.0
// Wires between a client and a service: values, functions, peeks and pokes, and how they end.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <boost/asio/use_future.hpp>
#include <chrono>
#include <future>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "rr/async.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/wired.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using ::testing::ElementsAre;

bool is_later(const TimeSpec& a, const TimeSpec& b) {
  return a.seconds != b.seconds ? a.seconds > b.seconds : a.nanoseconds > b.nanoseconds;
}

TEST(Wires, CarryValuesBothWays) {
  WiredPair pair;
  auto wired = pair.connect();
  WireConnection<double> level = wired->level().connect();
  EXPECT_TRUE(level.is_open());
  EXPECT_EQ(level.client(), 0U);
  EXPECT_EQ(error_of([&] { level.in(); }).code(), ErrorCode::value_not_set);
  EXPECT_FALSE(level.try_in());
  EXPECT_FALSE(level.out());
  pair.object->level().set_in(2.5);
  ASSERT_TRUE(level.wait_in(plenty));
  EXPECT_EQ(level.in(), 2.5);

  ASSERT_EQ(pair.object->level().connection_count(), 1U);
  ServedWire<double> served = pair.object->level().connections().front();
  EXPECT_EQ(served.client(), pair.service->clients().front().endpoint);
  EXPECT_EQ(served.in()->value, 2.5);
  level.set_out(-1.5);
  ASSERT_TRUE(served.wait_out(plenty));
  EXPECT_EQ(served.out(), -1.5);
  EXPECT_EQ(pair.object->level().out()->value, -1.5);
  EXPECT_EQ(level.out()->value, -1.5);
  EXPECT_EQ(served.try_out()->time, level.out()->time);
  EXPECT_EQ(level.try_in()->time, served.in()->time);
}

TEST(Wires, OfOneClientGetItsOwnValues) {
  WiredPair pair;
  auto one = pair.connect();
  auto other = pair.connect();
  auto level = one->level().connect();
  auto other_level = other->level().connect();
  for (ServedWire<double>& served : pair.object->level().connections()) {
    served.set_in(served.client());
    EXPECT_EQ(served.in()->value, served.client());
  }
  ASSERT_TRUE(level.wait_in(plenty));
  ASSERT_TRUE(other_level.wait_in(plenty));
  EXPECT_NE(level.in(), other_level.in());
  EXPECT_EQ(pair.object->level().connection_count(), 2U);
}

// What goes to all wakes each process once.
TEST(Wires, OfOneNodeStandTogether) {
  WiredPair pair;
  Node other;
  const std::string url = "rr+tcp://127.0.0.1:" + std::to_string(pair.port) + "/?service=wired";
  std::vector<Client<WiredStub>> clients;
  std::vector<WireConnection<double>> wires;
  for (Node* node : {&pair.client, &other, &pair.client, &other}) {
    clients.push_back(node->connect<WiredStub>(url));
    wires.push_back(clients.back()->level().connect());
  }
  std::map<std::uint32_t, NodeId> nodes;
  for (const ServiceClient& one : pair.service->clients()) nodes[one.endpoint] = one.node;
  std::vector<NodeId> order;
  for (const auto& served : pair.object->level().connections()) {
    order.push_back(nodes.at(served.client()));
  }
  EXPECT_THAT(order, ElementsAre(pair.client.id(), pair.client.id(), other.id(), other.id()));
  pair.object->level().set_in(7);
  for (auto& wire : wires) {
    ASSERT_TRUE(wire.wait_in(plenty));
    EXPECT_EQ(wire.in(), 7);
  }
}

TEST(Wires, AClientThatConnectsGetsTheLastValueAtOnce) {
  WiredPair pair;
  pair.object->note().set_in("first");
  pair.object->note().set_in("last");
  auto wired = pair.connect();
  auto note = wired->note().connect();
  EXPECT_EQ(note.in(), "last");  // it came before the answer
  EXPECT_EQ(pair.object->note().connections().front().in()->value, "last");
}

TEST(Wires, TheObjectIsToldOfAClientBeforeTheClientKnows) {
  WiredPair pair;
  pair.object->level().set_in(1);
  std::vector<double> seen;
  pair.object->level().on_connect([&](ServedWire<double> served) {
    seen.push_back(served.in()->value);
    served.set_in(2);
    EXPECT_EQ(ServiceContext::current_client(), served.client());
  });
  auto wired = pair.connect();
  auto level = wired->level().connect();
  EXPECT_THAT(seen, ElementsAre(1));
  EXPECT_EQ(level.in(), 2);
  pair.object->note().on_connect(
      [](const ServedWire<std::string>&) { throw Error(ErrorCode::invalid_state, "not now"); });
  EXPECT_EQ(error_of([&] { wired->note().connect(); }).code(), ErrorCode::invalid_state);
  EXPECT_EQ(pair.object->note().connection_count(), 0U);
  pair.object->note().on_connect([](ServedWire<std::string> served) { served.close(); });
  EXPECT_FALSE(wired->note().connect().is_open());
}

TEST(Wires, ValuesOfACallAreThereWhenItReturns) {
  WiredPair pair;
  auto wired = pair.connect();
  auto level = wired->level().connect();
  for (int i = 1; i <= 200; ++i) {
    wired->set_level(i);
    ASSERT_EQ(level.in(), i);
  }
  level.set_out(3);
  wired->set_level(0);
  EXPECT_EQ(pair.object->level().out()->value, 3);
  wired->close_level();
  EXPECT_FALSE(level.is_open());
}

TEST(Wires, AreConnectedOnceByAClient) {
  WiredPair pair;
  auto wired = pair.connect();
  auto level = wired->level().connect();
  EXPECT_EQ(error_of([&] { wired->level().connect(); }).code(), ErrorCode::invalid_operation);
  wired->set_level(4);
  EXPECT_EQ(level.in(), 4);
  auto child = wired->get_child("left");
  auto child_level = child->level().connect();
  pair.object->child->level().set_in(5);
  ASSERT_TRUE(child_level.wait_in(plenty));
  EXPECT_EQ(level.in(), 4);
  level.close();
  EXPECT_FALSE(level.is_open());
  level.close();
  EXPECT_EQ(error_of([&] { level.set_out(1); }).code(), ErrorCode::invalid_operation);
  EXPECT_EQ(pair.object->level().connection_count(), 0U);
  level = wired->level().connect();
  EXPECT_TRUE(level.is_open());
  EXPECT_EQ(level.in(), 4);
}

TEST(Wires, TimesOfASenderGrow) {
  WiredPair pair;
  auto wired = pair.connect();
  auto level = wired->level().connect();
  TimeSpec last;
  for (int i = 0; i < 1000; ++i) {
    level.set_out(i);
    const TimeSpec time = level.out()->time;
    ASSERT_TRUE(is_later(time, last));
    last = time;
  }
  ServedWire<double> served = pair.object->level().connections().front();
  EXPECT_TRUE(eventually([&] { return served.try_out() && served.out() == 999; }));
  for (int i = 0; i < 1000; ++i) {
    i % 2 == 0 ? served.set_in(i) : pair.object->level().set_in(i);
    ASSERT_TRUE(is_later(served.in()->time, last) || i == 0);
    last = served.in()->time;
  }
  EXPECT_TRUE(eventually([&] { return level.try_in() && level.in() == 999; }));
}

TEST(Wires, FunctionsGetTheValueThatIsThereAndThoseThatCome) {
  WiredPair pair;
  auto wired = pair.connect();
  auto level = wired->level().connect();
  wired->set_level(1);
  std::atomic<double> last = 0;
  std::atomic<int> count = 0;
  {
    // A function may have a state of its own that changes.
    const Subscription values =
        level.on_in([&, own = 0](double value, const TimeSpec& time) mutable {
          EXPECT_GT(time.seconds, 0);
          EXPECT_GT(value, last);
          last = value;
          count = ++own;
        });
    EXPECT_TRUE(eventually([&] { return last == 1; }));
    for (int i = 2; i <= 100; ++i) {
      wired->set_level(i);
      ASSERT_TRUE(eventually([&] { return last == i; }));
    }
    EXPECT_EQ(count, 100);
  }
  wired->set_level(500);
  EXPECT_EQ(level.in(), 500);
  EXPECT_EQ(last, 100);
}

TEST(Wires, ASlowFunctionGetsTheNewestValueAndHoldsUpNothing) {
  std::promise<void> go_on;
  WiredPair pair;
  auto wired = pair.connect();
  auto level = wired->level().connect();
  std::shared_future<void> gone_on = go_on.get_future().share();
  std::mutex mutex;
  std::vector<double> seen;
  const Subscription values = level.on_in([&](double value, const TimeSpec&) {
    {
      const std::lock_guard lock(mutex);
      seen.push_back(value);
    }
    gone_on.wait();
  });
  const auto count = [&] {
    const std::lock_guard lock(mutex);
    return seen.size();
  };
  wired->set_level(1);
  ASSERT_TRUE(eventually([&] { return count() == 1; }));
  for (int i = 2; i <= 50; ++i) wired->set_level(i);  // calls go on, and so do values
  EXPECT_EQ(level.in(), 50);
  go_on.set_value();
  ASSERT_TRUE(eventually([&] { return count() == 2; }));
  EXPECT_THAT(seen, ElementsAre(1, 50));
}

TEST(Wires, AFunctionMayUseTheWireAndEndItself) {
  std::promise<double> seen;
  WiredPair pair;
  auto wired = pair.connect();
  auto level = wired->level().connect();
  Subscription values;
  std::mutex mutex;
  {
    const std::lock_guard lock(mutex);
    values = level.on_in([&](double value, const TimeSpec&) {
      const std::lock_guard inner(mutex);
      wired->set_level(value + 1);
      level.set_out(value);
      values.disconnect();
      level.close();
      seen.set_value(value);
    });
  }
  wired->set_level(1);
  EXPECT_EQ(seen.get_future().get(), 1);
  EXPECT_FALSE(level.is_open());
  EXPECT_TRUE(eventually([&] { return pair.object->level().connection_count() == 0; }));
}

TEST(Wires, ValuesThatAreSentReachTheObject) {
  WiredPair pair;
  std::mutex mutex;
  std::vector<double> seen;
  std::uint32_t sender = 0;
  pair.object->target().on_out([&](double value, const TimeSpec& time, std::uint32_t client) {
    const std::lock_guard lock(mutex);
    EXPECT_GT(time.seconds, 0);
    sender = client;
    seen.push_back(value);
  });
  const auto count = [&] {
    const std::lock_guard lock(mutex);
    return seen.size();
  };
  auto wired = pair.connect();
  auto target = wired->target().connect();
  target.set_out(1);
  ASSERT_TRUE(eventually([&] { return count() == 1; }));
  wired->target().poke_out(2);
  EXPECT_EQ(count(), 2U);
  EXPECT_THAT(seen, ElementsAre(1, 2));
  EXPECT_EQ(sender, pair.service->clients().front().endpoint);
}

TEST(Wires, ArePeekedAndPokedWithoutAConnection) {
  WiredPair pair;
  auto wired = pair.connect();
  EXPECT_EQ(error_of([&] { wired->note().peek_in(); }).code(), ErrorCode::value_not_set);
  EXPECT_EQ(error_of([&] { wired->note().peek_out(); }).code(), ErrorCode::value_not_set);
  pair.object->note().set_in("from the service");
  const Timed<std::string> in = wired->note().peek_in();
  EXPECT_EQ(in.value, "from the service");
  std::this_thread::sleep_for(2ms);
  EXPECT_TRUE(is_later(wired->note().peek_in().time, in.time));  // the time of the answer
  wired->note().poke_out("from the client");
  EXPECT_EQ(pair.object->note().out()->value, "from the client");
  EXPECT_EQ(wired->note().peek_out().value, "from the client");
  pair.object->note().on_peek_in([] { return std::string("made up"); });
  pair.object->note().on_peek_out([]() -> std::string { throw Error(ErrorCode::io_error, "no"); });
  EXPECT_EQ(wired->note().peek_in().value, "made up");
  EXPECT_EQ(error_of([&] { wired->note().peek_out(); }).code(), ErrorCode::io_error);
}

TEST(Wires, OfOneDirectionRefuseTheOther) {
  WiredPair pair;
  auto wired = pair.connect();
  auto reading = wired->reading().connect();
  auto target = wired->target().connect();
  EXPECT_EQ(error_of([&] { reading.set_out(1); }).code(), ErrorCode::read_only_member);
  EXPECT_EQ(error_of([&] { wired->reading().peek_out(); }).code(), ErrorCode::read_only_member);
  EXPECT_EQ(error_of([&] { wired->reading().poke_out(1); }).code(), ErrorCode::read_only_member);
  EXPECT_EQ(error_of([&] { wired->target().peek_in(); }).code(), ErrorCode::write_only_member);
  EXPECT_EQ(error_of([&] { pair.object->target().set_in(1); }).code(),
            ErrorCode::write_only_member);
  ServedWire<double> served = pair.object->target().connections().front();
  EXPECT_EQ(error_of([&] { served.set_in(1); }).code(), ErrorCode::write_only_member);
  pair.object->reading().set_in(1);
  EXPECT_TRUE(reading.wait_in(plenty));
  target.set_out(2);
  EXPECT_TRUE(served.wait_out(plenty));
}

TEST(Wires, ValuesExpireAfterTheirLifespan) {
  WiredPair pair;
  auto wired = pair.connect();
  auto level = wired->level().connect();
  level.set_lifespan(30ms);
  pair.object->level().set_lifespan(30ms);
  // On a busy machine a value may be too old by the time that it is looked for.
  EXPECT_TRUE(eventually([&] {
    pair.object->level().set_in(1);
    return level.try_in().has_value();
  }));
  EXPECT_TRUE(eventually([&] {
    level.set_out(1);
    return pair.object->level().out().has_value();
  }));
  EXPECT_TRUE(eventually([&] { return !level.try_in() && !pair.object->level().out(); }));
  EXPECT_FALSE(level.wait_in(1ms));
  EXPECT_EQ(error_of([&] { level.in(); }).code(), ErrorCode::value_not_set);
  EXPECT_EQ(error_of([&] { wired->level().peek_out(); }).code(), ErrorCode::value_not_set);
  level.set_lifespan(0ms);
  EXPECT_EQ(level.in(), 1);
}

TEST(Wires, LargeValuesTravelToManyClients) {
  WiredPair pair;
  std::vector<Client<WiredStub>> clients;
  std::vector<WireConnection<Array<double>>> traces;
  for (int i = 0; i < 5; ++i) {
    clients.push_back(pair.connect());
    traces.push_back(clients.back()->trace().connect());
  }
  Array<double> values(100000);
  for (std::size_t i = 0; i < values.size(); ++i) values.mutate()[i] = static_cast<double>(i);
  pair.object->trace().set_in(values);
  for (auto& trace : traces) {
    ASSERT_TRUE(trace.wait_in(plenty));
    EXPECT_EQ(trace.in(), values);
  }
  const Array<double> huge(2000000);
  EXPECT_EQ(error_of([&] { traces.front().set_out(huge); }).code(), ErrorCode::protocol_error);
  traces.front().set_out(values);
  EXPECT_TRUE(eventually([&] { return pair.object->trace().out().has_value(); }));
}

TEST(Wires, HaveAsynchronousForms) {
  WiredPair pair;
  auto wired = pair.connect();
  pair.object->level().set_in(1.5);
  auto level = wired->level().async_connect(boost::asio::use_future).get();
  EXPECT_TRUE(level.is_open());
  EXPECT_EQ(level.in(), 1.5);
  auto second = wired->level().async_connect(boost::asio::use_future);
  EXPECT_EQ(error_of([&] { second.get(); }).code(), ErrorCode::invalid_operation);
  wired->level().async_poke_out(2.5, boost::asio::use_future).get();
  EXPECT_EQ(wired->level().async_peek_out(boost::asio::use_future).get().value, 2.5);
  EXPECT_EQ(wired->level().async_peek_in(boost::asio::use_future).get().value, 1.5);
  auto refused = wired->target().async_peek_in(boost::asio::use_future);
  EXPECT_EQ(error_of([&] { refused.get(); }).code(), ErrorCode::write_only_member);
  wired.close();
  auto late = wired->note().async_connect(boost::asio::use_future);
  EXPECT_EQ(error_of([&] { late.get(); }).code(), ErrorCode::invalid_operation);
}

}  // namespace
}  // namespace rr::testing
