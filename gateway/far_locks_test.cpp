// SPDX-License-Identifier: Apache-2.0
// Locks and monitors of a robot's objects, taken by clients of a serving gateway.
#include "gateway/far_locks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <string>

#include "gateway/testing/memory_broker.hpp"
#include "gateway/testing/rig.hpp"
#include "rr/locks.hpp"

namespace rr::gateway {
namespace {

using std::chrono::milliseconds;
using testing::code_of;
using testing::comes_true;
using testing::MemoryBroker;
using testing::Rig;

// The limit is longer than what a slow machine and a broker that drops messages make of the 300 ms
// between two of them.
constexpr const char* with_locks =
    "session_limit = \"4 s\"\n"
    "[[service.user]]\nbroker = \"hub\"\nservice = \"operator\"\npassword_file = \"secret\"\n"
    "[[service.allow]]\nmembers = [\"*\"]\naccess = [\"lock\"]\n"
    "[[service.allow]]\npath = \"tools[*]\"\nmembers = [\"*\"]\naccess = [\"lock\"]\n";

/// A time limit of requests that no test reaches.
constexpr milliseconds lock_patience{20'000};

/// Two clients of one serving gateway, and one of the robot itself.
class FarLocksTest : public ::testing::Test {
 protected:
  static ErrorCode use(const dynamic::Client& client) {
    return code_of([&] { return client->get("speed"); });
  }
  static ErrorCode lock_by(const dynamic::Client& client, LockOwner owner) {
    return code_of([&] {
      lock(client->stub(), owner);
      return 0;
    });
  }
  /// Whether the robot's own client may use the object, at last.
  bool is_released() {
    return comes_true([&] { return use(near) == ErrorCode::none; });
  }

  MemoryBroker broker{23};
  Rig rig{[this] { return broker.carriers(); }, lock_patience, with_locks};
  Node node;
  dynamic::Client near = dynamic::connect(node, rig.robot.url(), Rig::login());
  dynamic::Client one = rig.connect();
  dynamic::Client two = rig.connect();
};

TEST_F(FarLocksTest, OfASessionKeepOutAllOthers) {
  lock(one->stub(), LockOwner::session);
  EXPECT_EQ(use(one), ErrorCode::none);
  EXPECT_EQ(use(two), ErrorCode::object_locked_error);
  EXPECT_EQ(use(near), ErrorCode::object_locked_error);
  EXPECT_EQ(lock_by(two, LockOwner::session), ErrorCode::object_locked_error);
  unlock(one->stub());
  EXPECT_EQ(use(two), ErrorCode::none);
  EXPECT_EQ(use(near), ErrorCode::none);
}

TEST_F(FarLocksTest, OfAUserKeepOutOtherUsers) {
  lock(one->stub());
  EXPECT_EQ(use(one), ErrorCode::none);
  EXPECT_EQ(use(two), ErrorCode::none);
  EXPECT_EQ(use(near), ErrorCode::object_locked_error);
  // The user may release it in any session.
  unlock(two->stub());
  EXPECT_EQ(use(near), ErrorCode::none);
}

TEST_F(FarLocksTest, KeepOthersFromConnectingPipesAndWires) {
  const auto connect = [](const dynamic::Client& client, const std::string& member) {
    return code_of([&] {
      if (client->member(member).kind == MemberKind::pipe) {
        (void)client->pipe(member).connect();
      } else {
        (void)client->wire(member).connect();
      }
      return 0;
    });
  };
  for (const char* member : {"force", "target", "samples", "commands"}) {
    EXPECT_EQ(connect(two, member), ErrorCode::none) << member;
    lock(one->stub(), LockOwner::session);
    auto late = rig.connect();
    EXPECT_EQ(connect(late, member), ErrorCode::object_locked_error) << member;
    EXPECT_EQ(connect(one, member), ErrorCode::none) << member;
    unlock(one->stub());
    EXPECT_EQ(connect(late, member), ErrorCode::none) << member;
  }
}

// It has no endpoint for a pipe that sends nothing to it, and sees none come and go.
TEST_F(FarLocksTest, TheRobotSeesNoEndpointOfOneThatIsAskedAbout) {
  const std::size_t before = rig.robot.bench().pipe("commands").endpoint_count();
  std::atomic<int> connected{0};
  rig.robot.bench().pipe("commands").on_connect([&](const dynamic::PipeEndpoint&) { ++connected; });
  // Nothing is asked before the serving gateway knows that the robot is there.
  ASSERT_TRUE(comes_true([&] {
    (void)one->pipe("commands").connect();
    return broker.published("rr/hall/robot/bench/$connect/hub/commands") != 0;
  }));
  EXPECT_EQ(rig.robot.bench().pipe("commands").endpoint_count(), before);
  EXPECT_EQ(connected, 0);
}

TEST_F(FarLocksTest, ARobotThatIsNotThereIsNotAskedForThem) {
  lock(one->stub(), LockOwner::session);
  rig.stop_export();
  auto late = rig.connect();
  ASSERT_TRUE(comes_true(
      [&] { return code_of([&] { return late->wire("force").connect(); }) == ErrorCode::none; }));
  const char* const requests = "rr/hall/robot/bench/$connect/hub/#";
  const std::size_t before = broker.published(requests);
  EXPECT_EQ(code_of([&] { return late->wire("target").connect(); }), ErrorCode::none);
  EXPECT_EQ(broker.published(requests), before);
}

// Nothing says that it is away. What the broker drops is not counted as published.
TEST(FarLocksOfASilentRobot, AreNotAskedForAgainAtOnce) {
  MemoryBroker broker;
  Rig rig([&] { return broker.carriers(); }, milliseconds(1'000), with_locks);
  const auto client = rig.connect();
  const char* const requests = "rr/hall/robot/bench/$connect/hub/#";
  // Nothing is asked before the serving gateway knows that the robot is there.
  ASSERT_TRUE(comes_true([&] {
    (void)client->pipe("commands").connect();
    return broker.published(requests) != 0;
  }));
  const std::size_t before = broker.published(requests);
  broker.set_faults({.dropped = 1});
  EXPECT_EQ(code_of([&] { return client->wire("force").connect(); }), ErrorCode::none);
  broker.set_faults({});
  EXPECT_EQ(code_of([&] { return client->wire("target").connect(); }), ErrorCode::none);
  EXPECT_EQ(broker.published(requests), before);
}

TEST_F(FarLocksTest, AreOfSingleObjects) {
  const auto tool = one->object("tools", "left hand");
  lock(tool.stub(), LockOwner::session);
  EXPECT_EQ(use(two), ErrorCode::none);
  EXPECT_EQ(code_of([&] { return two->object("tools", "left hand").get("width"); }),
            ErrorCode::object_locked_error);
  unlock(tool.stub());
  EXPECT_EQ(two->object("tools", "left hand").get("width").as<double>(), 2.5);
}

TEST_F(FarLocksTest, OfTheRobotsClientsKeepOutFarOnes) {
  ConnectOptions options = Rig::login();
  options.username = "operator";
  const auto other = dynamic::connect(node, rig.robot.url(), options);
  lock(other->stub(), LockOwner::session);
  EXPECT_EQ(use(one), ErrorCode::object_locked_error);
  EXPECT_EQ(lock_by(one, LockOwner::session), ErrorCode::object_locked_error);
  unlock(other->stub());
  EXPECT_EQ(use(one), ErrorCode::none);
}

TEST_F(FarLocksTest, EndWithTheirClient) {
  lock(one->stub(), LockOwner::session);
  EXPECT_EQ(use(near), ErrorCode::object_locked_error);
  one.close();
  EXPECT_TRUE(is_released());
}

TEST_F(FarLocksTest, OfAUserEndWithTheClientThatHasMadeThem) {
  lock(one->stub());
  EXPECT_EQ(use(near), ErrorCode::object_locked_error);
  one.close();
  EXPECT_TRUE(is_released());
}

TEST_F(FarLocksTest, ThatAnotherSessionOfTheUserHasMadeAnewStay) {
  lock(one->stub());
  unlock(two->stub());
  lock(two->stub());
  one.close();
  // The session of the first has ended when that of the second is the only one.
  EXPECT_TRUE(comes_true([&] { return rig.robot.client_count() == 3; }));
  EXPECT_EQ(use(near), ErrorCode::object_locked_error);
}

TEST_F(FarLocksTest, EndWithTheServingGateway) {
  lock(one->stub(), LockOwner::session);
  EXPECT_EQ(use(near), ErrorCode::object_locked_error);
  rig.stop_server();
  EXPECT_TRUE(is_released());
}

TEST_F(FarLocksTest, EndWhenTheLinkIsAwayForLongerThanTheLimit) {
  lock(one->stub(), LockOwner::session);
  broker.set_links(false);
  EXPECT_TRUE(is_released());
  // The client notices that it has them no more.
  broker.set_links(true);
  EXPECT_TRUE(comes_true([&] { return !one.is_open(); }));
  EXPECT_EQ(use(two), ErrorCode::none);
}

TEST_F(FarLocksTest, LastWhileTheLinkIsThere) {
  lock(one->stub(), LockOwner::session);
  const std::string about_sessions = "rr/hall/robot/bench/$session/hub";
  // For longer than the limit, in which several messages say that the session is in use.
  const std::size_t before = broker.published(about_sessions);
  ASSERT_TRUE(comes_true([&] { return broker.published(about_sessions) >= before + 15; }));
  EXPECT_EQ(use(near), ErrorCode::object_locked_error);
  EXPECT_EQ(use(one), ErrorCode::none);
}

TEST_F(FarLocksTest, EndWithTheGatewayOfTheRobot) {
  lock(one->stub(), LockOwner::session);
  rig.stop_export();
  EXPECT_TRUE(is_released());
  rig.start_export();
  EXPECT_TRUE(comes_true([&] { return !one.is_open(); }));
  EXPECT_EQ(lock_by(two, LockOwner::session), ErrorCode::none);
}

TEST_F(FarLocksTest, TheClientIsDisconnectedWhenTheRobotEndsItsSession) {
  lock(one->stub(), LockOwner::session);
  EXPECT_TRUE(two.is_open());
  rig.robot.close();
  EXPECT_TRUE(comes_true([&] { return !one.is_open(); }));
  EXPECT_TRUE(two.is_open());
}

// An answer with this error makes clients end their session.
TEST_F(FarLocksTest, TheAnswerThatEndsTheSessionArrives) {
  for (int i = 0; i < 30; ++i) {
    const auto client = rig.connect();
    lock(client->stub(), LockOwner::session);
    EXPECT_EQ(code_of([&] { return client->call("fail", {std::string("invalid endpoint")}); }),
              ErrorCode::invalid_endpoint)
        << i;
    EXPECT_TRUE(is_released());
  }
}

TEST_F(FarLocksTest, AreTakenOnceOverABadLink) {
  broker.set_faults({.dropped = 0.2, .twice = 0.3, .delay = milliseconds(5)});
  for (int i = 0; i < 20; ++i) {
    // A second one would be refused.
    lock(one->stub(), LockOwner::session);
    EXPECT_EQ(use(one), ErrorCode::none);
    unlock(one->stub());
  }
  EXPECT_EQ(use(near), ErrorCode::none);
}

TEST_F(FarLocksTest, MonitorsKeepOutAllOthers) {
  enter_monitor(one->stub(), lock_patience);
  EXPECT_EQ(use(one), ErrorCode::none);
  EXPECT_EQ(use(two), ErrorCode::invalid_operation);
  EXPECT_EQ(use(near), ErrorCode::invalid_operation);
  EXPECT_EQ(code_of([&] {
              enter_monitor(two->stub(), milliseconds(50));
              return 0;
            }),
            ErrorCode::operation_timeout);
  exit_monitor(one->stub());
  EXPECT_EQ(use(two), ErrorCode::none);
}

TEST_F(FarLocksTest, AMonitorIsWaitedForAsLongAsItTakes) {
  enter_monitor(one->stub(), lock_patience);
  auto entered = std::async(std::launch::async, [&] { enter_monitor(two->stub()); });
  // Requests without an answer are repeated: by then it has been told to wait on, and asked again.
  const std::size_t before = broker.published("rr/hall/robot/bench/$lock/hub");
  ASSERT_TRUE(
      comes_true([&] { return broker.published("rr/hall/robot/bench/$lock/hub") >= before + 14; }));
  exit_monitor(one->stub());
  entered.get();
  EXPECT_EQ(use(one), ErrorCode::invalid_operation);
  exit_monitor(two->stub());
  EXPECT_EQ(use(one), ErrorCode::none);
}

TEST_F(FarLocksTest, OnlyThoseThatLockHaveASession) {
  EXPECT_EQ(use(one), ErrorCode::none);
  EXPECT_EQ(broker.published("rr/hall/robot/bench/$session/hub"), 0U);
  lock(one->stub(), LockOwner::session);
  EXPECT_GE(broker.published("rr/hall/robot/bench/$session/hub"), 1U);
}

TEST(FarLockRights, AreThoseOfTheExportFile) {
  MemoryBroker broker;
  Rig rig([&] { return broker.carriers(); }, lock_patience,
          "[[service.user]]\nbroker = \"hub\"\nservice = \"operator\"\npassword_file = "
          "\"secret\"\n");
  const auto far = rig.connect();
  EXPECT_EQ(code_of([&] {
              lock(far->stub());
              return 0;
            }),
            ErrorCode::permission_denied);
}

TEST(FarLockRights, AreThoseOfTheUserAtTheRobot) {
  MemoryBroker broker;
  Rig rig([&] { return broker.carriers(); }, lock_patience,
          "[[service.allow]]\nmembers = [\"*\"]\naccess = [\"lock\"]\n");
  const auto far = rig.connect();
  // The user `gateway` has no privilege to lock.
  EXPECT_EQ(code_of([&] {
              lock(far->stub());
              return 0;
            }),
            ErrorCode::object_locked_error);
  EXPECT_EQ(far->get("speed").as<double>(), 0.5);
}

TEST(FarLockOperations, HaveNames) {
  using Operation = LockRequest::Operation;
  for (const Operation operation :
       {Operation::lock_for_user, Operation::lock_for_session, Operation::unlock,
        Operation::enter_monitor, Operation::go_on_entering, Operation::exit_monitor}) {
    EXPECT_EQ(lock_operation(lock_operation_name(operation)), operation);
  }
  EXPECT_EQ(code_of([] { return lock_operation("break"); }), ErrorCode::invalid_argument);
}

}  // namespace
}  // namespace rr::gateway
