// SPDX-License-Identifier: Apache-2.0
// Clients that log in at a serving gateway, and who they are at the robot.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <memory>
#include <string>
#include <vector>

#include "gateway/far_calls.hpp"
#include "gateway/far_packets.hpp"
#include "gateway/far_sessions.hpp"
#include "gateway/outbox.hpp"
#include "gateway/testing/memory_broker.hpp"
#include "gateway/testing/rig.hpp"
#include "rr/locks.hpp"
#include "rr/users.hpp"

namespace rr::gateway {
namespace {

using std::chrono::milliseconds;
using testing::code_of;
using testing::comes_true;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::MemoryBroker;
using testing::Rig;

constexpr milliseconds login_patience{20'000};

// At the robot, alice is the operator; others are whom the gateway has logged in.
constexpr const char* with_clients =
    "[[service.user]]\nbroker = \"hub\"\nclient = \"alice\"\nservice = \"operator\"\n"
    "password_file = \"secret\"\n"
    "[[service.allow]]\nmembers = [\"*\"]\naccess = [\"lock\"]\n";

std::string people() {
  static const std::string text = "alice " + PasswordUsers::hash("wonder") + " _\nbob " +
                                  PasswordUsers::hash("builder") + " _\n";
  return text;
}

VarStringMap password(const std::string& text) { return {{"password", VarValue(text)}}; }

ConnectOptions as(const std::string& user, const std::string& text) {
  return {.username = user, .credentials = password(text)};
}

std::string name_at_robot(const dynamic::Client& client) { return client->call("whoami").text(); }

class FarLogins : public ::testing::Test {
 protected:
  FarLogins() {
    rig.stop_server();
    rig.served.users_file = rig.write_file("people", people());
    rig.start_server();
  }
  dynamic::Client alice() { return rig.connect(as("alice", "wonder")); }
  dynamic::Client bob() { return rig.connect(as("bob", "builder")); }

  MemoryBroker broker{29};
  Rig rig{[this] { return broker.carriers(); }, login_patience, with_clients};
};

TEST_F(FarLogins, EachClientIsItsUserAtTheRobot) {
  const auto one = alice();
  const auto two = bob();
  EXPECT_EQ(name_at_robot(one), "operator");
  EXPECT_EQ(name_at_robot(two), "gateway");
  EXPECT_EQ(name_at_robot(one), "operator");
}

TEST_F(FarLogins, WithoutOneNobodyGetsIn) {
  const auto one = alice();  // so that the service is there
  const auto refused = ErrorCode::authentication_error;
  EXPECT_EQ(code_of([&] { return rig.connect_once(); }), refused);
  EXPECT_EQ(code_of([&] { return rig.connect_once(as("alice", "builder")); }), refused);
  // The robot's users are none of the gateway's.
  EXPECT_EQ(code_of([&] { return rig.connect_once(Rig::login()); }), refused);
}

TEST_F(FarLogins, AClientMayBecomeAnotherUser) {
  auto client = alice();
  lock(client->stub(), LockOwner::session);
  const auto other = bob();
  EXPECT_EQ(code_of([&] { return other->get("speed"); }), ErrorCode::object_locked_error);
  client.authenticate("bob", password("builder"));
  // The session of the user before ends, and its lock with it.
  EXPECT_TRUE(
      comes_true([&] { return code_of([&] { return other->get("speed"); }) == ErrorCode::none; }));
  EXPECT_EQ(name_at_robot(client), "gateway");
  client.logout();
  EXPECT_EQ(code_of([&] { return client->get("speed"); }), ErrorCode::authentication_error);
  client.authenticate("alice", password("wonder"));
  EXPECT_EQ(name_at_robot(client), "operator");
}

TEST_F(FarLogins, LocksOfAUserAreForAllItsClients) {
  const auto one = alice();
  const auto same = alice();
  const auto other = bob();
  lock(one->stub());
  EXPECT_EQ(same->get("speed").as<double>(), 0.5);
  EXPECT_EQ(code_of([&] { return other->get("speed"); }), ErrorCode::object_locked_error);
  unlock(same->stub());
  EXPECT_EQ(other->get("speed").as<double>(), 0.5);
}

TEST_F(FarLogins, RightsOfTheGatewayHoldBeforeThoseOfTheRobot) {
  rig.stop_server();
  rig.served.rights_file =
      rig.write_file("rights", "allow user:alice\nallow user:bob access get,describe\n");
  rig.start_server();
  const auto one = alice();
  const auto two = bob();
  EXPECT_EQ(one->call("add", {1.5, 2.0}).as<double>(), 3.5);
  EXPECT_EQ(two->get("speed").as<double>(), 0.5);
  try {
    two->call("add", {1.5, 2.0});
    ADD_FAILURE() << "bob may call";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::authentication_error);
    EXPECT_EQ(error.message(), "User `bob` may not call `add` of `bench`");
  }
}

TEST_F(FarLogins, MistakesInFilesAreToldAtTheStart) {
  rig.stop_server();
  const std::string good = rig.served.users_file;
  rig.served.users_file = rig.write_file("nobody", "alice\n");
  EXPECT_EQ(code_of([&] {
              rig.start_server();
              return 0;
            }),
            ErrorCode::invalid_configuration);
  rig.served.users_file = good;
  rig.served.rights_file = rig.write_file("rights", "user:alice\n");
  EXPECT_EQ(code_of([&] {
              rig.start_server();
              return 0;
            }),
            ErrorCode::invalid_configuration);
}

/// A broker that answers nothing.
class SilentCarrier final : public Carrier {
 public:
  void start(CarrierHandler&, Message) override {}
  void stop(const Message&) override {}
  Published publish(const Message& message) override {
    sent.push_back(message);
    return Published::taken;
  }
  void subscribe(const std::string&) override {}
  [[nodiscard]] std::string url() const override { return "silent"; }

  std::vector<Message> sent;
};

/// Sessions at a robot that has not answered yet. The worker never starts to tick by itself: what
/// is posted to it runs, and nothing else.
class FarSessionsOfUsers : public ::testing::Test {
 protected:
  void SetUp() override {
    worker->start();
    on_worker([this] { calls->set_connected(true); });
    sessions->begin(1);
  }
  void TearDown() override {
    worker->stop();
    calls->abort();
  }
  void on_worker(const Function<void()>& task) {
    std::promise<void> done;
    worker->post([&] {
      task();
      done.set_value();
    });
    done.get_future().wait();
  }
  FarCalls::Done note(const std::string& name) {
    return [this, name](const std::exception_ptr& error, const Message&) {
      const bool is_refused = code_of([&] {
                                if (error) std::rethrow_exception(error);
                                return 0;
                              }) == ErrorCode::authentication_error;
      ends.add(name + (is_refused ? " is refused" : " has ended"));
    };
  }
  /// The robot's gateway does what it was asked for in the last message.
  void answer() {
    Message done;
    done.correlation = last.correlation;
    on_worker([&] { calls->take(done); });
  }
  std::shared_ptr<FarPackets> pipe() {
    return std::make_shared<FarPackets>(sessions, 1, FarRequest{address, Verb::get, "", "log"},
                                        dynamic::ValueType::parse("double"), FarPackets::Limits(),
                                        [this](const std::string& reason) { ends.add(reason); });
  }
  /// The first packet of alice is on its way to the robot.
  std::shared_ptr<FarPackets> pipe_of_alice() {
    sessions->require();
    sessions->set_user(1, "alice");
    auto packets = pipe();
    packets->add(1.0);
    EXPECT_THAT(sent(), ElementsAre("open alice"));
    answer();
    EXPECT_THAT(sent(), ElementsAre("1 -"));
    return packets;
  }
  /// What was sent since the last look: the operation, or how many packets, and the user of each
  /// message.
  std::vector<std::string> sent() {
    std::vector<std::string> texts;
    on_worker([&] {
      outbox.pump(carrier, [](const Message&) {});
      for (const Message& message : carrier.sent) {
        const auto what = message.find("op");
        texts.push_back(std::string(what ? *what : message.find("count").value_or("?")) + " " +
                        std::string(message.find("client-user").value_or("-")));
        names.emplace_back(message.find("session").value_or(""));
        last = message;
      }
      carrier.sent.clear();
    });
    return texts;
  }
  void ask(const std::string& name) {
    sessions->request_in_session(1, {address, Verb::get, "", "speed"}, note(name));
  }

  const ServiceAddress address{"hall", "robot", "bench"};
  Outbox outbox;
  SilentCarrier carrier;
  std::shared_ptr<Worker> worker = std::make_shared<Worker>(std::chrono::hours(1), [] {});
  std::shared_ptr<FarCalls> calls =
      std::make_shared<FarCalls>(worker, outbox, FarCalls::Options{.user = "hub"}, [] {});
  std::shared_ptr<FarSessions> sessions = std::make_shared<FarSessions>(
      calls, address, FarSessions::Limits(), [](std::uint32_t, const std::string&) {});
  testing::Kept<std::string> ends;
  std::vector<std::string> names;  // of sessions, of all that was sent
  Message last;
};

TEST_F(FarSessionsOfUsers, ASessionIsOpenedForTheUserOfItsFirstRequest) {
  sessions->set_user(1, "alice");
  EXPECT_THAT(sent(), IsEmpty());
  ask("first");
  EXPECT_THAT(sent(), ElementsAre("open alice"));
  sessions->set_user(1, "alice");
  ask("second");
  EXPECT_THAT(sent(), IsEmpty());
  EXPECT_EQ(ends.size(), 0U);
}

TEST_F(FarSessionsOfUsers, WhatWaitsForASessionIsNotDoneAsAnotherUser) {
  sessions->set_user(1, "alice");
  ask("first");
  ask("second");
  sessions->set_user(1, "bob");
  EXPECT_THAT(ends.items(), ElementsAre("first is refused", "second is refused"));
  ask("third");
  EXPECT_THAT(sent(), ElementsAre("open alice", "end -", "open bob"));
  EXPECT_EQ(names[0], names[1]);
  EXPECT_NE(names[0], names[2]);
  EXPECT_EQ(ends.size(), 2U);
}

TEST_F(FarSessionsOfUsers, PacketsThatWaitAreNotSentAsAnotherUser) {
  const auto packets = pipe_of_alice();
  packets->add(2.0);
  packets->add(3.0);
  sessions->set_user(1, "bob");
  answer();
  EXPECT_THAT(sent(), ElementsAre("end -"));
  EXPECT_THAT(ends.items(),
              ElementsAre("RobotRaconteur.AuthenticationError: the client's user has changed"));
  packets->add(4.0);
  EXPECT_THAT(sent(), IsEmpty());
}

TEST_F(FarSessionsOfUsers, PacketsOfTwoUsersDoNotTravelTogether) {
  const auto packets = pipe_of_alice();
  packets->add(2.0);
  sessions->set_user(1, "bob");
  packets->add(3.0);
  EXPECT_THAT(ends.items(), ElementsAre("packets of another user wait for the robot"));
  answer();
  EXPECT_THAT(sent(), ElementsAre("end -"));
}

TEST_F(FarSessionsOfUsers, PacketsAfterALoginAreOfTheNewUser) {
  const auto packets = pipe_of_alice();
  answer();
  sessions->set_user(1, "bob");
  packets->add(2.0);
  EXPECT_THAT(sent(), ElementsAre("end -", "open bob"));
  answer();
  EXPECT_THAT(sent(), ElementsAre("1 -"));
  EXPECT_EQ(ends.size(), 0U);
}

TEST_F(FarSessionsOfUsers, AClientWithoutAUserSaysNone) {
  ask("first");
  EXPECT_THAT(sent(), ElementsAre("open -"));
}

TEST_F(FarSessionsOfUsers, OfAClientThatHasGoneThereIsNoUser) {
  sessions->end(1);
  sessions->set_user(1, "alice");
  ask("first");
  EXPECT_THAT(ends.items(), ElementsAre("first has ended"));
  EXPECT_THAT(sent(), IsEmpty());
}

}  // namespace
}  // namespace rr::gateway
