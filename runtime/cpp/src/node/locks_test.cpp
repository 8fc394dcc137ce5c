// SPDX-License-Identifier: Apache-2.0
#include "rr/locks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <semaphore>
#include <span>
#include <string>
#include <thread>

#include "rr/call.hpp"
#include "rr/lock_keeper.hpp"
#include "rr/users.hpp"
#include "runtime/cpp/src/channel/testing/quiet_tap.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;

// A counter that sessions may have to themselves.
class Monitored final : public Counter {
 public:
  using Counter::Counter;
  [[nodiscard]] bool rr_has_monitor() const override { return true; }
  bool rr_monitor_enter(std::chrono::milliseconds timeout) override {
    ++asked;
    if (!free.try_acquire_for(timeout)) return false;
    ++inside;
    return true;
  }
  void rr_monitor_exit() override {
    --inside;
    free.release();
  }

  std::binary_semaphore free{1};
  std::atomic<int> inside{0};
  std::atomic<int> asked{0};
};

// MD5 of the names.
constexpr const char* accounts =
    "alice 6384e2b2184bcbf58eccf10ca7a6563c objectlock\n"
    "bob 9f9d51bc70ef21ca5c14f307980a29d8 objectlock\n"
    "guest 084e0343a0486ff05530df6c705c8bb4 _\n"
    "chief 80dbf87f21babc680482e0b37bff584d objectlockoverride\n";

struct Secured : Pair {
  explicit Secured(std::chrono::milliseconds patience = 30s)
      : Secured(std::make_shared<Monitored>(), patience) {}
  Secured(std::shared_ptr<Monitored> offered, std::chrono::milliseconds patience,
          std::shared_ptr<Tap> client_tap = nullptr)
      : Pair({}, {.tap = std::move(client_tap)}, offered,
             {.users = std::make_shared<PasswordUsers>(accounts), .monitor_patience = patience}),
        counter(std::move(offered)) {}
  Client<CounterStub> connect_as(const std::string& user) {
    return connect({.username = user, .credentials = {{"password", user}}});
  }
  const std::shared_ptr<Monitored> counter;
};

constexpr auto locked = ErrorCode::object_locked_error;
constexpr auto none = ErrorCode::none;

TEST(Locks, KeepOtherUsersOut) {
  Secured pair;
  auto alice = pair.connect_as("alice");
  auto again = pair.connect_as("alice");
  auto bob = pair.connect_as("bob");
  lock(*alice);
  EXPECT_EQ(alice->get_value(), 0);
  EXPECT_EQ(again->get_value(), 0);
  EXPECT_EQ(error_of([&] { bob->get_value(); }).message(), "Object locked by alice");
  EXPECT_EQ(code_of([&] { bob->set_value(1); }), locked);
  EXPECT_EQ(code_of([&] { bob->add(1, 2); }), locked);
  EXPECT_EQ(code_of([&] { lock(*bob); }), locked);
  EXPECT_EQ(code_of([&] { lock(*alice); }), locked);
  EXPECT_EQ(code_of([&] { unlock(*bob); }), locked);
  unlock(*again);
  EXPECT_EQ(bob->get_value(), 0);
  unlock(*bob);  // nothing is locked
}

TEST(Locks, OfASessionKeepTheUsersOtherSessionsOutToo) {
  Secured pair;
  auto alice = pair.connect_as("alice");
  auto again = pair.connect_as("alice");
  lock(*alice, LockOwner::session);
  EXPECT_EQ(alice->get_value(), 0);
  EXPECT_EQ(code_of([&] { again->get_value(); }), locked);
  unlock(*again);
  EXPECT_EQ(again->get_value(), 0);
}

TEST(Locks, OfTheServiceStayWhetherOrNotTheUserIsThere) {
  Secured pair;
  pair.service->lock("counter", "alice");
  auto bob = pair.connect_as("bob");
  EXPECT_EQ(error_of([&] { bob->get_value(); }).message(), "Object locked by alice");
  {
    auto alice = pair.connect_as("alice");
    EXPECT_EQ(alice->get_value(), 0);
    EXPECT_EQ(code_of([&] { lock(*alice); }), locked);
  }
  EXPECT_TRUE(eventually([&] { return pair.service->clients().size() == 1; }));
  EXPECT_EQ(code_of([&] { bob->get_value(); }), locked);
  EXPECT_EQ(code_of([&] { unlock(*bob); }), locked);
  EXPECT_TRUE(pair.service->unlock("counter"));
  EXPECT_EQ(bob->get_value(), 0);
  EXPECT_FALSE(pair.service->unlock("counter"));
  EXPECT_FALSE(pair.service->unlock("counter.no path["));
}

TEST(Locks, OfTheServiceEndAsThoseOfTheUser) {
  Secured pair;
  auto alice = pair.connect_as("alice");
  auto chief = pair.connect_as("chief");
  pair.service->lock("counter", "alice");
  unlock(*alice);
  EXPECT_EQ(chief->get_value(), 0);
  pair.service->lock("counter", "alice");
  EXPECT_EQ(code_of([&] { chief->get_value(); }), locked);
  unlock(*chief);
  EXPECT_EQ(chief->get_value(), 0);
}

TEST(Locks, OfTheServiceForNobodyKeepEverybodyOut) {
  Secured pair;
  auto alice = pair.connect_as("alice");
  auto chief = pair.connect_as("chief");
  const auto child = alice->get_child();
  pair.service->lock("counter.by_name[left]");  // nobody has looked for it yet
  EXPECT_EQ(alice->get_value(), 0);
  EXPECT_EQ(child->get_value(), 0);
  const auto left = alice->get_by_name("left");
  EXPECT_EQ(error_of([&] { left->get_value(); }).message(), "Object locked by the service");
  EXPECT_EQ(code_of([&] { lock(*alice); }), locked);  // above it
  EXPECT_EQ(code_of([&] { unlock(*left); }), locked);
  EXPECT_EQ(code_of([&] { pair.service->lock("counter"); }), locked);
  EXPECT_EQ(code_of([&] { pair.service->lock("counter.nothing"); }), ErrorCode::member_not_found);
  unlock(*chief->get_by_name("left"));
  EXPECT_EQ(left->get_value(), 0);
}

TEST(Locks, OfTheServiceNeedNoUsers) {
  Pair pair;
  auto counter = pair.connect();
  const auto child = counter->get_child();
  pair.service->lock("counter.child");
  EXPECT_EQ(counter->get_value(), 0);
  EXPECT_EQ(code_of([&] { child->get_value(); }), locked);
  EXPECT_TRUE(pair.service->unlock("counter.child"));
  EXPECT_EQ(child->get_value(), 0);
}

TEST(Locks, HoldForWhatLiesBelow) {
  Secured pair;
  auto alice = pair.connect_as("alice");
  auto bob = pair.connect_as("bob");
  const auto child = bob->get_child();
  const auto mine = alice->get_child();
  lock(*alice);
  EXPECT_EQ(code_of([&] { child->get_value(); }), locked);
  const auto later = bob->get_by_name("new");
  EXPECT_EQ(code_of([&] { later->get_value(); }), locked);
  EXPECT_EQ(code_of([&] { lock(*mine); }), locked);
  EXPECT_EQ(code_of([&] { unlock(*mine); }), locked);  // not where it was made
  unlock(*alice);
  lock(*mine);
  EXPECT_EQ(bob->get_value(), 0);
  EXPECT_EQ(code_of([&] { child->get_value(); }), locked);
  EXPECT_EQ(later->get_value(), 0);
  EXPECT_EQ(code_of([&] { lock(*bob); }), locked);  // something below is
  unlock(*mine);
}

TEST(Locks, NeedAPrivilege) {
  Secured pair;
  auto guest = pair.connect_as("guest");
  EXPECT_EQ(code_of([&] { lock(*guest); }), locked);
  guest.logout();
  EXPECT_EQ(code_of([&] { lock(*guest); }), ErrorCode::authentication_error);
  EXPECT_EQ(code_of([&] { unlock(*guest); }), ErrorCode::authentication_error);
  auto alice = pair.connect_as("alice");
  auto chief = pair.connect_as("chief");
  lock(*alice);
  EXPECT_EQ(code_of([&] { chief->get_value(); }), locked);
  unlock(*chief);
  lock(*chief);
  EXPECT_EQ(code_of([&] { alice->get_value(); }), locked);
}

TEST(Locks, NeedUsers) {
  Pair pair;
  auto client = pair.connect();
  EXPECT_EQ(code_of([&] { lock(*client); }), ErrorCode::invalid_operation);
  EXPECT_EQ(code_of([&] { lock(*client, LockOwner::session); }), ErrorCode::invalid_operation);
  EXPECT_EQ(code_of([&] { unlock(*client); }), ErrorCode::invalid_operation);
}

TEST(Locks, EndWithTheLastSessionOfTheUser) {
  Secured pair;
  auto bob = pair.connect_as("bob");
  auto again = pair.connect_as("alice");
  {
    auto alice = pair.connect_as("alice");
    lock(*alice);
  }
  EXPECT_TRUE(eventually([&] { return pair.service->clients().size() == 2; }));
  EXPECT_EQ(code_of([&] { bob->get_value(); }), locked);
  again.close();
  EXPECT_TRUE(eventually([&] { return code_of([&] { bob->get_value(); }) == none; }));
}

TEST(Locks, OfASessionEndWithIt) {
  Secured pair;
  auto bob = pair.connect_as("bob");
  auto again = pair.connect_as("alice");
  {
    auto alice = pair.connect_as("alice");
    lock(*alice, LockOwner::session);
    EXPECT_EQ(code_of([&] { again->get_value(); }), locked);
  }
  EXPECT_TRUE(eventually([&] { return code_of([&] { again->get_value(); }) == none; }));
}

TEST(Locks, OutliveTheLogOutOfTheirUser) {
  Secured pair;
  auto client = pair.connect_as("alice");
  lock(*client, LockOwner::session);
  client.logout();
  client.authenticate("bob", {{"password", "bob"}});
  EXPECT_EQ(code_of([&] { client->get_value(); }), locked);
  client.authenticate("alice", {{"password", "alice"}});
  EXPECT_EQ(client->get_value(), 0);
}

TEST(Locks, EndWhenTheObjectIsReleased) {
  Secured pair;
  auto alice = pair.connect_as("alice");
  auto bob = pair.connect_as("bob");
  lock(*alice->get_by_name("a"));
  EXPECT_EQ(code_of([&] { bob->get_by_name("a")->get_value(); }), locked);
  pair.service->release_path("counter.by_name[a]");
  EXPECT_EQ(bob->get_by_name("a")->get_value(), 0);
}

// Says yes to everything, and keeps what it was asked and told.
class Agreeing final : public LockKeeper {
 public:
  void keep(LockRequest request, Answer answer) override {
    {
      const MutexLock lock(mutex_);
      asked_.push_back(std::move(request));
    }
    answer(nullptr, false);
  }
  void set_user(std::uint32_t client, const std::string& user) override {
    const MutexLock lock(mutex_);
    users_.emplace_back(client, user);
  }
  std::vector<std::pair<std::uint32_t, std::string>> users() const {
    const MutexLock lock(mutex_);
    return users_;
  }
  std::vector<LockRequest> asked() const {
    const MutexLock lock(mutex_);
    return asked_;
  }

 private:
  mutable Mutex mutex_;
  std::vector<LockRequest> asked_ RR_GUARDED_BY(mutex_);
  std::vector<std::pair<std::uint32_t, std::string>> users_ RR_GUARDED_BY(mutex_);
};

TEST(Locks, AreLeftToAKeeperFromTheFirstRequestOn) {
  const auto keeper = std::make_shared<Agreeing>();
  Pair pair({}, {}, std::make_shared<Counter>(), {.lock_keeper = keeper});  // needs no users
  auto one = pair.connect();
  auto other = pair.connect();
  lock(*one, LockOwner::session);
  EXPECT_EQ(other->get_value(), 0);  // the service itself knows of no lock
  unlock(*one);
  enter_monitor(*one, 250ms);
  exit_monitor(*one);
  const std::vector<LockRequest> asked = keeper->asked();
  using Operation = LockRequest::Operation;
  std::vector<Operation> operations;
  for (const LockRequest& request : asked) {
    operations.push_back(request.operation);
    EXPECT_EQ(request.path, one->rr_path());
    EXPECT_NE(request.client, 0U);
  }
  EXPECT_THAT(operations,
              ::testing::ElementsAre(Operation::lock_for_session, Operation::unlock,
                                     Operation::enter_monitor, Operation::exit_monitor));
  EXPECT_EQ(asked.at(2).timeout, 250ms);
}

TEST(Locks, AKeeperKnowsForWhom) {
  const auto keeper = std::make_shared<Agreeing>();
  Pair pair({}, {}, std::make_shared<Counter>(),
            {.users = std::make_shared<PasswordUsers>(accounts), .lock_keeper = keeper});
  auto client = pair.connect({.username = "alice", .credentials = {{"password", "alice"}}});
  const std::uint32_t number = pair.service->clients().front().endpoint;
  EXPECT_EQ(code_of([&] {
              client.authenticate("bob", {{"password", "alice"}});
            }),
            ErrorCode::authentication_error);
  client.authenticate("bob", {{"password", "bob"}});
  client.logout();
  client.logout();
  EXPECT_THAT(keeper->users(), ::testing::ElementsAre(std::pair(number, std::string("alice")),
                                                      std::pair(number, std::string("bob")),
                                                      std::pair(number, std::string())));
}

TEST(Monitors, LetOneSessionIn) {
  Secured pair;
  auto alice = pair.connect_as("alice");
  auto bob = pair.connect_as("bob");
  enter_monitor(*alice, 2s);
  EXPECT_EQ(pair.counter->inside, 1);
  EXPECT_EQ(alice->get_value(), 0);
  EXPECT_EQ(code_of([&] { bob->get_value(); }), ErrorCode::invalid_operation);
  EXPECT_EQ(code_of([&] { enter_monitor(*bob, 50ms); }), ErrorCode::operation_timeout);
  EXPECT_EQ(code_of([&] { enter_monitor(*bob, 0ms); }), ErrorCode::operation_timeout);
  EXPECT_EQ(code_of([&] { enter_monitor(*alice); }), ErrorCode::invalid_operation);
  EXPECT_EQ(code_of([&] { exit_monitor(*bob); }), ErrorCode::invalid_operation);
  exit_monitor(*alice);
  EXPECT_EQ(pair.counter->inside, 0);
  enter_monitor(*bob, 0ms);
  EXPECT_EQ(bob->get_value(), 0);
  exit_monitor(*bob);
  EXPECT_EQ(alice->get_value(), 0);
}

TEST(Monitors, AreWaitedForLongerThanForAnAnswer) {
  Secured pair;
  auto alice = pair.connect_as("alice");
  auto bob = pair.connect_as("bob");
  enter_monitor(*alice);
  bob->rr_set_timeout(400ms);
  EXPECT_EQ(code_of([&] { enter_monitor(*bob, 600ms); }), ErrorCode::operation_timeout);
  exit_monitor(*alice);
  enter_monitor(*bob, 600ms);
  exit_monitor(*bob);
}

TEST(Monitors, NeedAnObjectThatHasOne) {
  Secured pair;
  auto alice = pair.connect_as("alice");
  EXPECT_EQ(code_of([&] { enter_monitor(*alice->get_child(), 1s); }), ErrorCode::invalid_argument);
  exit_monitor(*alice);                              // nobody was in yet
  Pair open({}, {}, std::make_shared<Monitored>());  // needs no users
  auto client = open.connect();
  const MonitorLock in(*client);
  EXPECT_EQ(client->get_value(), 0);
}

// Counts the requests for monitors that a client has given to its connections.
class EnterTap final : public QuietTap {
 public:
  std::uint64_t message(std::uint32_t /*connection*/, Direction direction,
                        std::span<const Piece> message) override {
    std::string bytes;
    for (const Piece& piece : message) {
      bytes.append(reinterpret_cast<const char*>(piece.data), piece.size);
    }
    if (direction == Direction::to_service && bytes.find("MonitorEnter") != std::string::npos) {
      ++count;
    }
    return 0;
  }

  std::atomic<int> count{0};
};

TEST(Monitors, AreEnteredInTheOrderOfAsking) {
  const auto tap = std::make_shared<EnterTap>();
  Secured pair(std::make_shared<Monitored>(), 30s, tap);
  auto first = pair.connect_as("alice");
  enter_monitor(*first);
  std::vector<Client<CounterStub>> clients;
  std::vector<std::future<void>> waiting;
  std::mutex mutex;
  std::vector<int> order;
  for (int i = 0; i < 4; ++i) {
    clients.push_back(pair.connect_as("bob"));
    waiting.push_back(std::async(std::launch::async, [&, i, stub = clients.back().stub()] {
      const MonitorLock in(*stub, 10s);
      EXPECT_EQ(pair.counter->inside, 1);
      const std::lock_guard lock(mutex);
      order.push_back(i);
    }));
    // The service has it once it answers what this session sends behind it.
    ASSERT_TRUE(eventually([&] { return tap->count == i + 2; }));
    EXPECT_EQ(code_of([&] { clients.back()->get_value(); }), ErrorCode::invalid_operation);
  }
  EXPECT_EQ(first->get_value(), 0);
  exit_monitor(*first);
  for (auto& one : waiting) one.get();
  EXPECT_THAT(order, ::testing::ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(pair.counter->inside, 0);
}

TEST(Monitors, ThatTheProgramHoldsAreWaitedForBeyondAnAnswer) {
  Secured pair;
  auto alice = pair.connect_as("alice");
  pair.counter->free.acquire();
  EXPECT_EQ(code_of([&] { enter_monitor(*alice, 100ms); }), ErrorCode::operation_timeout);
  auto entered = std::async(std::launch::async, [&] { enter_monitor(*alice); });
  // The service tells the client every 5 s to wait on.
  EXPECT_EQ(entered.wait_for(5500ms), std::future_status::timeout);
  EXPECT_EQ(alice->get_value(), 0);  // waiting holds up nothing else
  pair.counter->free.release();
  entered.get();
  EXPECT_EQ(pair.counter->inside, 1);
  exit_monitor(*alice);
}

TEST(Monitors, EndWithTheSession) {
  Secured pair;
  auto bob = pair.connect_as("bob");
  {
    auto alice = pair.connect_as("alice");
    enter_monitor(*alice);
    EXPECT_EQ(code_of([&] { bob->get_value(); }), ErrorCode::invalid_operation);
  }
  EXPECT_TRUE(eventually([&] { return code_of([&] { bob->get_value(); }) == none; }));
  EXPECT_EQ(pair.counter->inside, 0);
}

TEST(Monitors, ASessionThatGivesUpWaitingIsNotLetIn) {
  Secured pair;
  auto alice = pair.connect_as("alice");
  pair.counter->free.acquire();
  with_options(within(50ms), [&] {
    EXPECT_EQ(code_of([&] { enter_monitor(*alice); }), ErrorCode::request_timeout);
  });
  exit_monitor(*alice);
  pair.counter->free.release();
  auto bob = pair.connect_as("bob");
  enter_monitor(*bob, 5s);
  EXPECT_EQ(pair.counter->inside, 1);
  exit_monitor(*bob);
  EXPECT_TRUE(eventually([&] { return pair.counter->inside == 0; }));
}

TEST(Monitors, ThatAreNotUsedAreLost) {
  Secured pair(200ms);
  auto alice = pair.connect_as("alice");
  auto bob = pair.connect_as("bob");
  enter_monitor(*alice);
  for (int i = 0; i < 8; ++i) {
    std::this_thread::sleep_for(50ms);
    EXPECT_EQ(alice->get_value(), 0);  // keeps it
  }
  EXPECT_EQ(pair.counter->inside, 1);
  enter_monitor(*bob, 10s);  // after alice has lost it
  EXPECT_EQ(pair.counter->inside, 1);
  EXPECT_EQ(code_of([&] { exit_monitor(*alice); }), ErrorCode::invalid_operation);
}

TEST(Monitors, EndWhenTheObjectIsReleasedOrTheServiceCloses) {
  class Parent final : public Counter {
   public:
    std::shared_ptr<Skeleton> get_by_name(const std::string&) override { return child; }
    const std::shared_ptr<Monitored> child = std::make_shared<Monitored>("child");
  };
  const auto parent = std::make_shared<Parent>();
  Pair pair({}, {}, parent);
  auto client = pair.connect();
  auto other = pair.connect();
  // A client that asks only after the release gets the monitor of what is there then, and has to
  // give it back.
  ErrorCode code = ErrorCode::none;
  for (int left = 100; left != 0 && code == ErrorCode::none; --left) {
    enter_monitor(*client->get_by_name("a"));
    auto waiting = std::async(std::launch::async, [stub = other->get_by_name("a")] {
      const ErrorCode end = code_of([&] { enter_monitor(*stub); });
      if (end == ErrorCode::none) exit_monitor(*stub);
      return end;
    });
    std::this_thread::sleep_for(50ms);
    pair.service->release_path("counter.by_name[a]");
    code = waiting.get();
  }
  EXPECT_EQ(code, ErrorCode::object_not_found);
  EXPECT_EQ(parent->child->inside, 0);
  enter_monitor(*client->get_by_name("a"));
  pair.service->close();
  EXPECT_TRUE(eventually([&] { return parent->child->inside == 0; }));
}

TEST(Monitors, ManySessionsTakeTurns) {
  Secured pair;
  std::vector<std::jthread> threads;
  std::atomic<int> most{0};
  for (int i = 0; i < 8; ++i) {
    threads.emplace_back([&] {
      auto client = pair.connect_as("alice");
      for (int round = 0; round < 10; ++round) {
        const MonitorLock in(*client, 60s);
        client->set_value(client->get_value() + 1);
        most = std::max(most.load(), pair.counter->inside.load());
      }
    });
  }
  threads.clear();
  EXPECT_EQ(most, 1);
  EXPECT_EQ(pair.counter->get_value(), 80);
}

}  // namespace
}  // namespace rr::testing
