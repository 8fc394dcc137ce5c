// SPDX-License-Identifier: Apache-2.0
// Functions of far clients that the robot calls.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <string>

#include "gateway/testing/memory_broker.hpp"
#include "gateway/testing/rig.hpp"

namespace rr::gateway {
namespace {

using std::chrono::milliseconds;
using testing::comes_true;
using testing::MemoryBroker;
using testing::Rig;

constexpr milliseconds callback_patience{20'000};

/// The bench with a callback, and functions that call it.
std::string definition_with_callback() {
  std::string text = testing::bench_definition;
  const std::string place = "object Bench\n";
  return text.insert(text.find(place) + place.size(),
                     "  callback double ask(double x)\n  callback void hidden()\n"
                     "  function double call_ask(double x)\n  function void call_hidden()\n");
}

constexpr const char* with_callback =
    "session_limit = \"4 s\"\n"
    "[[service.allow]]\nmembers = [\"ask\", \"call_ask\", \"call_hidden\"]\naccess = [\"call\"]\n";

template <class Call>
Error error_of_callback(Call call) {
  try {
    static_cast<void>(call());
  } catch (const Error& error) {
    return error;
  }
  return {ErrorCode::none, "no error"};
}

class FarCallbacks : public ::testing::Test {
 protected:
  FarCallbacks() {
    const dynamic::WeakServedObject bench(rig.robot.bench());
    rig.robot.bench().on_call("call_ask", [bench](const dynamic::List& arguments) {
      return bench.lock().call_back("ask", ServiceContext::current_client(), {arguments[0]});
    });
    rig.robot.bench().on_call("call_hidden", [bench](const dynamic::List&) {
      return bench.lock().call_back("hidden", ServiceContext::current_client());
    });
  }

  MemoryBroker broker{31};
  Rig rig{[this] { return broker.carriers(); }, callback_patience, with_callback, "open sesame",
          definition_with_callback()};
  dynamic::Client one = rig.connect();
  dynamic::Client two = rig.connect();
};

TEST_F(FarCallbacks, ReachTheClientThatHasSetThem) {
  one->callback("ask").set(
      [](const dynamic::List& arguments) { return arguments[0].as<double>() + 1; });
  two->callback("ask").set(
      [](const dynamic::List& arguments) { return arguments[0].as<double>() + 2; });
  EXPECT_EQ(one->call("call_ask", {10}).as<double>(), 11);
  EXPECT_EQ(two->call("call_ask", {10}).as<double>(), 12);
}

TEST_F(FarCallbacks, ErrorsOfTheClientArriveAsTheyAre) {
  one->callback("ask").set([](const dynamic::List&) -> dynamic::Value {
    throw Error(ErrorCode::remote_error, "test.bench.Jam", "not now");
  });
  const Error error = error_of_callback([&] { return one->call("call_ask", {1}); });
  EXPECT_EQ(error.name(), "test.bench.Jam");
  EXPECT_EQ(error.message(), "not now");
}

TEST_F(FarCallbacks, WithoutAFunctionTheRobotIsTold) {
  EXPECT_EQ(error_of_callback([&] { return one->call("call_ask", {1}); }).code(),
            ErrorCode::invalid_operation);
}

TEST_F(FarCallbacks, ThatAreNotExportedAreNotThere) {
  std::atomic<int> called{0};
  one->callback("hidden").set([&](const dynamic::List&) {
    ++called;
    return dynamic::Value();
  });
  EXPECT_EQ(error_of_callback([&] { return one->call("call_hidden"); }).code(),
            ErrorCode::invalid_operation);
  EXPECT_EQ(called, 0);
}

TEST_F(FarCallbacks, AreCalledOnceOverABadLink) {
  broker.set_faults({.dropped = 0.2, .twice = 0.3, .delay = milliseconds(5)});
  std::atomic<int> called{0};
  one->callback("ask").set([&](const dynamic::List& arguments) {
    ++called;
    return arguments[0];
  });
  for (int i = 0; i < 20; ++i) ASSERT_EQ(one->call("call_ask", {i}).as<int>(), i);
  EXPECT_EQ(called, 20);
}

TEST_F(FarCallbacks, MayCallTheRobotThemselves) {
  one->callback("ask").set([this](const dynamic::List& arguments) {
    return one->call("add", {arguments[0], 5}).as<double>();
  });
  EXPECT_EQ(one->call("call_ask", {1}).as<double>(), 6);
}

TEST_F(FarCallbacks, EndWithTheClient) {
  one->callback("ask").set([](const dynamic::List& arguments) { return arguments[0]; });
  EXPECT_EQ(one->call("call_ask", {1}).as<double>(), 1);
  EXPECT_EQ(two->call("add", {1, 2}).as<double>(), 3);
  // Two sessions of clients, and that of the gateway.
  EXPECT_EQ(rig.robot.client_count(), 3U);
  one.close();
  EXPECT_TRUE(comes_true([&] { return rig.robot.client_count() == 2; }));
  EXPECT_EQ(two->call("add", {1, 2}).as<double>(), 3);
}

}  // namespace
}  // namespace rr::gateway
