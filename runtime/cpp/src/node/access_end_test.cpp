// SPDX-License-Identifier: Apache-2.0
// What a session has opened ends when its user goes, or may have it no more.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <boost/asio/use_future.hpp>
#include <chrono>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "rr/async.hpp"
#include "runtime/cpp/src/node/testing/guarded_client.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

std::vector<EntryType> types_of(std::vector<RawClient::Answer>& passed) {
  std::vector<EntryType> types;
  for (const RawClient::Answer& each : passed) types.push_back(each.type);
  passed.clear();
  return types;
}

std::uint32_t only_client(const GuardedService& service) {
  return service.service->clients().at(0).endpoint;
}

TEST(LoggingOut, ClosesWiresAndPipesAndNothingComesAfterwards) {
  GuardedService service;
  GuardedClient client(service, "alice");
  client.connect_wire();
  client.connect_pipe();
  client.settle();
  EXPECT_EQ(client.log_out(), 0);
  EXPECT_THAT(types_of(client.passed),
              UnorderedElementsAre(EntryType::wire_closed, EntryType::pipe_closed));
  EXPECT_EQ(service.object->level().connection_count(), 0U);
  EXPECT_EQ(service.object->samples().endpoint_count(), 0U);
  for (int i = 0; i < 20; ++i) {
    service.object->level().set_in(i);
    service.object->samples().send(i);
    service.object->notice(i);
  }
  EXPECT_THAT(client.settle(), IsEmpty());
  // Nor does what was open come back with the user.
  EXPECT_EQ(client.log_in("alice"), 0);
  service.object->level().set_in(1);
  service.object->samples().send(1);
  EXPECT_THAT(client.settle(), IsEmpty());
}

TEST(LoggingOut, ClosesTheHandlesOfAnOrdinaryClient) {
  GuardedService service;
  const std::uint16_t port = service.node.listen_tcp(0, "127.0.0.1");
  Node node;
  auto client = node.connect<GuardedStub>(
      "rr+tcp://127.0.0.1:" + std::to_string(port) + "/?service=guarded",
      {.username = "alice", .credentials = {{"password", std::string("alice")}}});
  auto wire = client->level().connect();
  auto pipe = client->samples().connect();
  auto steps = client->count();
  EXPECT_EQ(steps.next(), 1);
  client.logout();
  EXPECT_TRUE(eventually([&] { return !wire.is_open() && !pipe.is_open(); }));
  EXPECT_EQ(code_of([&] { (void)steps.next(); }), ErrorCode::authentication_error);
}

TEST(LoggingOut, EndsCallbacksThatWait) {
  GuardedService service;
  GuardedClient client(service, "alice");
  const std::uint32_t number = only_client(service);
  auto answer = service.object->async_ask(number, boost::asio::use_future);
  EXPECT_EQ(client.log_out(), 0);
  EXPECT_EQ(code_of([&] { answer.get(); }), ErrorCode::authentication_error);
  EXPECT_EQ(code_of([&] { (void)service.object->ask(number); }), ErrorCode::authentication_error);
  const std::vector<EntryType> came = types_of(client.passed);
  EXPECT_EQ(std::count(came.begin(), came.end(), EntryType::callback_call_req), 1);
}

TEST(LoggingOut, LeavesMonitors) {
  GuardedService service;
  GuardedClient alice(service, "alice");
  GuardedClient bob(service, "bob");
  const auto at_once = element<std::int32_t>("timeout", 0);
  EXPECT_EQ(alice.operation("MonitorEnter", "guarded", at_once), 0);
  EXPECT_EQ(bob.operation("MonitorEnter", "guarded", at_once), code(ErrorCode::operation_timeout));
  EXPECT_EQ(alice.log_out(), 0);
  EXPECT_EQ(bob.operation("MonitorEnter", "guarded", element<std::int32_t>("timeout", 5000)), 0);
}

// A call that runs meanwhile has no answer for who is not there any more.
TEST(LoggingOut, DuringACallKeepsItsResult) {
  GuardedService service;
  service.object->on_run = [&](const std::string&) {
    try {
      return service.object->ask(ServiceContext::current_client());
    } catch (const Error&) {
      return 42.0;
    }
  };
  for (const bool is_replaced : {false, true}) {
    GuardedClient client(service, "alice");
    client.raw().send(EntryType::function_call_req, "guarded", "run",
                      element<std::string>("what", "x"));
    ASSERT_EQ(client.raw().receive().value().type, EntryType::callback_call_req);
    EXPECT_EQ(is_replaced ? client.log_in("bob") : client.log_out(), 0);
    auto result = client.passed.empty() ? client.raw().receive().value() : client.passed.front();
    EXPECT_EQ(result.type, EntryType::function_call_res);
    EXPECT_EQ(result.error, refused);
  }
}

TEST(LoggingOut, WhileAWireIsBeingConnectedLeavesNoneConnected) {
  GuardedService service;
  service.object->level().on_connect([&](const ServedWire<double>& wire) {
    EXPECT_EQ(code_of([&] { (void)service.object->ask(wire.client()); }),
              ErrorCode::authentication_error);
  });
  GuardedClient client(service, "alice");
  client.raw().send(EntryType::wire_connect_req, "guarded", "level");
  while (client.raw().receive().value().type != EntryType::callback_call_req) {
  }
  EXPECT_EQ(client.log_out(), 0);
  client.log_in("bob");
  service.object->level().set_in(7);
  client.settle();
  EXPECT_EQ(service.object->level().connection_count(), 0U);
}

TEST(LoggingIn, AgainAsTheSameUserKeepsWhatIsOpen) {
  GuardedService service;
  GuardedClient client(service, "alice");
  client.connect_wire();
  const std::int32_t index = client.open_generator();
  client.settle();
  EXPECT_EQ(client.log_in("alice"), 0);
  EXPECT_EQ(client.log_in("bob", "wrong"), refused);
  EXPECT_THAT(types_of(client.passed), IsEmpty());
  EXPECT_EQ(client.step(index), 0);
  service.object->level().set_in(3);
  EXPECT_THAT(client.settle(), ::testing::ElementsAre(EntryType::wire_packet));
  client.raw().send(EntryType::wire_packet, "guarded", "level", GuardedClient::wire_value(1));
  EXPECT_TRUE(eventually([&] { return service.object->values == 1; }));
}

TEST(LoggingIn, AsAnotherUserEndsWhatTheFirstHasOpened) {
  GuardedService service;
  GuardedClient client(service, "alice");
  client.connect_wire();
  client.connect_pipe();
  client.settle();
  EXPECT_EQ(client.log_in("bob"), 0);
  EXPECT_THAT(types_of(client.passed),
              UnorderedElementsAre(EntryType::wire_closed, EntryType::pipe_closed));
}

TEST(LoggingIn, OfAClientWithoutAUserKeepsWhatTheUserMayHave) {
  auto options = GuardedService::with_rights(
      "deny  user:*  member samples access connect\n"
      "allow anyone  member level,samples access connect\n");
  options.require_user = false;
  GuardedService service(std::move(options));
  GuardedClient client(service, "");
  EXPECT_EQ(client.connect_wire(), 0);
  client.connect_pipe();
  client.settle();
  EXPECT_EQ(client.log_in("guest"), 0);
  EXPECT_THAT(types_of(client.passed), ::testing::ElementsAre(EntryType::pipe_closed));
  EXPECT_EQ(service.object->level().connection_count(), 1U);
}

TEST(LosingARight, EndsWhatWasOpenAndNothingElse) {
  GuardedService service(GuardedService::with_rights("allow user:*\n"));
  GuardedClient alice(service, "alice");
  GuardedClient bob(service, "bob");
  for (GuardedClient* client : {&alice, &bob}) {
    EXPECT_EQ(client->connect_wire(), 0);
    client->connect_pipe();
  }
  const std::int32_t first = alice.open_generator();
  const std::int32_t other = bob.open_generator();
  EXPECT_EQ(alice.operation("RequestObjectLock", "guarded.child[a]"), 0);
  auto asked = service.object->async_ask(only_client(service), boost::asio::use_future);
  alice.settle();
  bob.settle();
  service.service->set_rights(
      std::make_shared<Rights>("allow user:alice member samples access connect\n"
                               "allow user:bob\n"));
  EXPECT_THAT(alice.settle(), ::testing::ElementsAre(EntryType::wire_closed));
  EXPECT_THAT(bob.settle(), IsEmpty());
  EXPECT_EQ(alice.step(first), refused);
  EXPECT_EQ(bob.step(other), 0);
  EXPECT_EQ(code_of([&] { asked.get(); }), ErrorCode::authentication_error);
  service.object->level().set_in(3);
  service.object->samples().send(3);
  service.object->notice(3);
  EXPECT_THAT(alice.settle(), ::testing::ElementsAre(EntryType::pipe_packet));
  EXPECT_THAT(bob.settle(), UnorderedElementsAre(EntryType::wire_packet, EntryType::pipe_packet,
                                                 EntryType::event_req));
  // She may connect, and no longer send.
  alice.raw().send(EntryType::pipe_packet, "guarded", "samples", GuardedClient::pipe_packet(1, 1));
  EXPECT_EQ(alice.raw().receive().value().error, refused);
  EXPECT_EQ(service.object->packets, 0);
  // Nor is her lock in the way of others.
  EXPECT_EQ(bob.ask(EntryType::property_get_req, "guarded.child[a]", "value"), 0);
}

TEST(LosingARight, OfAMonitorLeavesIt) {
  GuardedService service(GuardedService::with_rights("allow user:*\n"));
  GuardedClient alice(service, "alice");
  EXPECT_EQ(alice.operation("MonitorEnter", "guarded", element<std::int32_t>("timeout", 0)), 0);
  service.service->set_rights(std::make_shared<Rights>("allow user:* access get,set\n"));
  EXPECT_TRUE(service.object->free.try_acquire_for(std::chrono::seconds(10)));
  EXPECT_EQ(alice.operation("MonitorEnter", "guarded", element<std::int32_t>("timeout", 0)),
            refused);
}

// A client that says so of the service's endpoint has no session any more.
TEST(AnInvalidEndpoint, EndsTheSessionAndItsConnection) {
  GuardedService service;
  GuardedClient alice(service, "alice");
  const auto begin = std::chrono::steady_clock::now();
  const RawClient::Request request{.type = EntryType::event_req,
                                   .path = "guarded",
                                   .member = "noticed",
                                   .error = code(ErrorCode::invalid_endpoint)};
  alice.raw().send({&request, 1});
  EXPECT_FALSE(alice.raw().receive(20'000).has_value());
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
  EXPECT_THAT(service.service->clients(), IsEmpty());
}

// A client that waits is told to ask again every 5 s.
TEST(WaitingForAMonitor, EndsWithItsTimeForAClientThatDoesNotAskAgain) {
  GuardedService service;
  GuardedClient alice(service, "alice");
  GuardedClient bob(service, "bob");
  GuardedClient chief(service, "chief");
  const auto enter = [](GuardedClient& client, std::int32_t timeout) {
    const auto answer = client.answer(EntryType::client_session_op_req, "guarded", "MonitorEnter",
                                      element("timeout", timeout));
    return answer.error == 0 ? answer.value_of<std::string>("return") : std::string("refused");
  };
  EXPECT_EQ(enter(alice, 0), "OK");
  EXPECT_EQ(enter(bob, 5'500), "Continue");
  std::this_thread::sleep_for(std::chrono::milliseconds(700));
  auto entered = std::async(std::launch::async, [&] { return enter(chief, 20'000); });
  EXPECT_EQ(entered.wait_for(std::chrono::milliseconds(50)), std::future_status::timeout);
  EXPECT_EQ(alice.operation("MonitorExit"), 0);
  ASSERT_EQ(entered.wait_for(std::chrono::seconds(10)), std::future_status::ready);
  EXPECT_EQ(entered.get(), "OK");
  EXPECT_EQ(bob.operation("MonitorContinueEnter"), code(ErrorCode::operation_timeout));
}

}  // namespace
}  // namespace rr::testing
