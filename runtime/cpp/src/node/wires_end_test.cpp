// SPDX-License-Identifier: Apache-2.0
// How wires end, and many threads at once.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "runtime/cpp/src/node/testing/gate.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/wired.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;

// Both ends of a wire, and how often each was told that it is closed.
struct Ends {
  explicit Ends(WiredPair& pair, Client<WiredStub>& wired) {
    client = wired->level().connect();
    service = pair.object->level().connections().back();
    client.on_closed([told = told] { ++told->first; });
    service.on_closed([told = told] { ++told->second; });
  }
  [[nodiscard]] bool have_ended() const {
    return eventually([&] { return told->first != 0 && told->second != 0; }) && told->first == 1 &&
           told->second == 1 && !client.is_open() && !service.is_open();
  }

  struct Told {
    std::atomic<int> first = 0;
    std::atomic<int> second = 0;
  };
  std::shared_ptr<Told> told = std::make_shared<Told>();
  WireConnection<double> client;
  ServedWire<double> service;
};

TEST(WireEnds, AreClosedByTheClient) {
  std::promise<void> late;
  WiredPair pair;
  auto wired = pair.connect();
  Ends ends(pair, wired);
  ends.client.close();
  EXPECT_TRUE(ends.have_ended());
  EXPECT_EQ(pair.object->level().connection_count(), 0U);
  EXPECT_EQ(error_of([&] { ends.service.set_in(1); }).code(), ErrorCode::invalid_operation);
  ends.client.on_closed([&] { late.set_value(); });
  EXPECT_EQ(late.get_future().wait_for(plenty), std::future_status::ready);
}

TEST(WireEnds, AreClosedByTheService) {
  std::promise<double> last;
  WiredPair pair;
  auto wired = pair.connect();
  Ends ends(pair, wired);
  Subscription values = ends.client.on_in([&](double value, const TimeSpec&) {
    if (value == 2) last.set_value(value);
  });
  ends.service.set_in(2);  // still comes
  ends.service.close();
  EXPECT_EQ(last.get_future().get(), 2);
  EXPECT_TRUE(ends.have_ended());
  EXPECT_EQ(error_of([&] { ends.client.set_out(1); }).code(), ErrorCode::invalid_operation);
  EXPECT_TRUE(wired->level().connect().is_open());
}

TEST(WireEnds, EndWithTheSessionWhoeverEndsIt) {
  WiredPair pair;
  {
    auto wired = pair.connect();
    Ends ends(pair, wired);
    wired.close();
    EXPECT_TRUE(ends.have_ended());
    EXPECT_EQ(error_of([&] { wired->level().connect(); }).code(), ErrorCode::invalid_operation);
  }
  {
    auto wired = pair.connect();
    Ends ends(pair, wired);
    pair.service->disconnect(ends.service.client());
    EXPECT_TRUE(ends.have_ended());
  }
  auto wired = pair.connect();
  Ends ends(pair, wired);
  pair.service->close();
  EXPECT_TRUE(ends.have_ended());
}

TEST(WireEnds, EndWithTheNodes) {
  {
    WiredPair pair;
    auto wired = pair.connect();
    Ends ends(pair, wired);
    pair.server.shutdown();
    EXPECT_TRUE(ends.have_ended());
  }
  WiredPair pair;
  auto wired = pair.connect();
  Ends ends(pair, wired);
  pair.client.shutdown();
  EXPECT_TRUE(ends.have_ended());
}

TEST(WireEnds, OutliveTheirHandles) {
  WiredPair pair;
  auto wired = pair.connect();
  std::atomic<double> seen = 0;
  wired->level().connect().on_in([&](double value, const TimeSpec&) { seen = value; }).detach();
  wired->set_level(3);
  EXPECT_TRUE(eventually([&] { return seen == 3; }));
  EXPECT_EQ(pair.object->level().connection_count(), 1U);
}

TEST(WireEnds, EndWhenTheirObjectIsReleased) {
  WiredPair pair;
  auto wired = pair.connect();
  auto child = wired->get_child("left");
  auto level = child->level().connect();
  Ends root(pair, wired);
  std::atomic<int> closed = 0;
  level.on_closed([&] { ++closed; });
  pair.service->release_path("wired.child[left]");
  EXPECT_EQ(pair.object->child->level().connection_count(), 0U);
  EXPECT_TRUE(eventually([&] { return closed == 1; }));
  EXPECT_FALSE(level.is_open());
  EXPECT_TRUE(root.client.is_open());
  EXPECT_TRUE(root.service.is_open());
  EXPECT_TRUE(wired->get_child("left")->level().connect().is_open());
}

TEST(WireEnds, AreNotEndedByAReleaseBeforeTheyWereConnected) {
  Gate gate;
  std::atomic<int> released = 0;
  WiredPair pair;
  auto wired = pair.connect({.on_path_released = [&](const std::string&) {
    ++released;
    gate.pass();  // what comes now waits for this function; answers do not
  }});
  (void)wired->get_child("left");
  pair.service->release_path("wired.child[left]");
  ASSERT_TRUE(gate.has_entered());
  const auto child = wired->get_child("left");
  pair.service->release_path("wired.child[left]");
  auto level = child->level().connect();
  ASSERT_TRUE(level.is_open());
  gate.open();
  ASSERT_TRUE(eventually([&] { return released == 2; }));
  pair.object->child->level().set_in(3);
  EXPECT_TRUE(level.wait_in(plenty));
  EXPECT_TRUE(level.is_open());
  pair.service->release_path("wired.child[left]");
  EXPECT_TRUE(eventually([&] { return !level.is_open(); }));
}

TEST(WireEnds, EndWhenTheirObjectIsReleasedWhileTheyAreConnected) {
  WiredPair pair;
  auto wired = pair.connect();
  const auto child = wired->get_child("left");
  std::atomic<bool> has_released = false;
  pair.object->child->level().on_connect([&](const ServedWire<double>&) {
    if (!has_released.exchange(true)) pair.service->release_path("wired.child[left]");
  });
  auto level = child->level().connect();
  EXPECT_TRUE(eventually([&] { return !level.is_open(); }));
  EXPECT_EQ(pair.object->child->level().connection_count(), 0U);
  EXPECT_TRUE(wired->get_child("left")->level().connect().is_open());
}

TEST(WireEnds, WhatFunctionsHoldIsFreedAtTheEnd) {
  WiredPair pair;
  auto wired = pair.connect();
  const auto held = std::make_shared<int>(1);
  const auto is_free = [&] { return eventually([&] { return held.use_count() == 1; }); };
  {
    auto level = wired->level().connect();
    Subscription values = level.on_in([held, level](double, const TimeSpec&) {});
    level.on_closed([held, level] {});
    pair.object->level().connections().front().on_out([held](double, const TimeSpec&) {}).detach();
    EXPECT_GT(held.use_count(), 3);
    values.disconnect();
    level.close();
    EXPECT_TRUE(is_free());
  }
  auto level = wired->level().connect();
  level.on_in([held, level](double, const TimeSpec&) {}).detach();
  level.on_closed([held, level] {});
  wired.close();
  EXPECT_TRUE(is_free());
}

TEST(WireEnds, AWaiterGoesOnWhenTheEndComes) {
  WiredPair pair;
  auto wired = pair.connect();
  auto level = wired->level().connect();
  auto waiting = std::async(std::launch::async, [&] { return level.wait_in(plenty); });
  std::this_thread::sleep_for(5ms);
  level.close();
  EXPECT_FALSE(waiting.get());
  auto note = wired->note().connect();
  auto lost = std::async(std::launch::async, [&] { return note.wait_in(plenty); });
  std::this_thread::sleep_for(5ms);
  pair.server.shutdown();
  EXPECT_FALSE(lost.get());
}

TEST(WireEnds, ValuesArriveWhileAFunctionWaitsForThem) {
  std::promise<bool> has_come;
  WiredPair pair;
  auto wired = pair.connect();
  auto level = wired->level().connect();
  // The request of a client waits for a value of the same client.
  pair.object->on_set_level = [&] {
    has_come.set_value(pair.object->level().connections().front().wait_out(plenty));
  };
  auto call = std::async(std::launch::async, [&] { wired->set_level(1); });
  ASSERT_TRUE(level.wait_in(plenty));
  level.set_out(2);
  EXPECT_TRUE(has_come.get_future().get());
  call.get();
}

TEST(WireEnds, ManyThreadsSendConnectAndLeave) {
  WiredPair pair;
  constexpr int clients = 4;
  std::atomic<bool> is_over = false;
  std::atomic<int> received = 0;
  pair.object->level().on_out([&](double, const TimeSpec&, std::uint32_t) { ++received; });
  pair.object->level().on_connect([](ServedWire<double> served) { served.set_in(0); });
  std::vector<std::thread> threads;
  for (int i = 0; i < 2; ++i) {
    threads.emplace_back([&] {
      for (double value = 1; !is_over; ++value) {
        pair.object->level().set_in(value);
        for (ServedWire<double>& served : pair.object->level().connections()) {
          try {
            served.set_in(value);
          } catch (const Error& error) {
            EXPECT_TRUE(error.code() == ErrorCode::invalid_operation ||
                        error.code() == ErrorCode::connection_error)
                << error.what();
          }
        }
        std::this_thread::sleep_for(1ms);
      }
    });
  }
  std::vector<std::thread> leavers;
  for (int i = 0; i < clients; ++i) {
    leavers.emplace_back([&, i] {
      for (int round = 0; round < 15; ++round) {
        auto wired = pair.connect();
        auto level = wired->level().connect();
        std::atomic<int> seen = 0;
        TimeSpec last;
        const Subscription values = level.on_in([&](double, const TimeSpec& time) {
          EXPECT_TRUE(time.seconds > last.seconds ||
                      (time.seconds == last.seconds && time.nanoseconds > last.nanoseconds));
          last = time;
          ++seen;
        });
        EXPECT_TRUE(eventually([&] {
          level.set_out(round);
          return seen >= 3;
        }));
        if (round % 3 == i % 3) level.close();
      }
    });
  }
  for (std::thread& thread : leavers) thread.join();
  is_over = true;
  for (std::thread& thread : threads) thread.join();
  EXPECT_GT(received, 0);
  EXPECT_TRUE(eventually([&] { return pair.object->level().connection_count() == 0; }));
}

TEST(WireEnds, AreRefusedAfterTheEndAsRequestsAre) {
  WiredPair pair;
  auto sent_away = pair.connect();
  pair.service->disconnect(pair.service->clients().at(0).endpoint);
  ASSERT_TRUE(eventually([&] { return !sent_away.is_open(); }));
  EXPECT_EQ(error_of([&] { sent_away->level().connect(); }).code(), ErrorCode::invalid_operation);
  EXPECT_EQ(error_of([&] { sent_away->set_level(1); }).code(), ErrorCode::invalid_operation);
  auto closed = pair.connect();
  closed.close();
  EXPECT_EQ(error_of([&] { closed->level().connect(); }).code(), ErrorCode::invalid_operation);
  EXPECT_EQ(error_of([&] { closed->set_level(1); }).code(), ErrorCode::invalid_operation);
}

}  // namespace
}  // namespace rr::testing
