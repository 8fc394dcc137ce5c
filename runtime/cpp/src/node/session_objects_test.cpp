// SPDX-License-Identifier: Apache-2.0
// Objects of clients' own: what per_client() makes of an objref.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <map>
#include <mutex>
#include <semaphore>
#include <string>
#include <thread>
#include <vector>

#include "rr/locks.hpp"
#include "rr/users.hpp"
#include "runtime/cpp/src/node/testing/board.hpp"
#include "runtime/cpp/src/node/testing/gate.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/wired.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""ms;
using ::testing::ElementsAre;

// What becomes of objects.
class Lives {
 public:
  void note(const std::string& what) {
    const std::lock_guard lock(mutex_);
    notes_.push_back(what);
    threads_.push_back(std::this_thread::get_id());
  }
  std::vector<std::string> notes() {
    const std::lock_guard lock(mutex_);
    return notes_;
  }
  std::size_t count(const std::string& what) {
    const std::lock_guard lock(mutex_);
    return static_cast<std::size_t>(std::count(notes_.begin(), notes_.end(), what));
  }
  std::vector<std::thread::id> threads() {
    const std::lock_guard lock(mutex_);
    return threads_;
  }

 private:
  std::mutex mutex_;
  std::vector<std::string> notes_;
  std::vector<std::thread::id> threads_;
};

// A counter that is a client's own, and so is what lies below.
class Mine : public Counter {
 public:
  explicit Mine(std::shared_ptr<Lives> lives) : lives_(std::move(lives)) { lives_->note("made"); }
  ~Mine() override { lives_->note("gone"); }
  void rr_released(const std::string& path) override { lives_->note("released " + path); }
  std::shared_ptr<Skeleton> get_child() override { return std::make_shared<Mine>(lives_); }
  void reset() override {
    if (gate) gate->pass();
    Counter::reset();
  }
  [[nodiscard]] bool rr_has_monitor() const override { return true; }
  bool rr_monitor_enter(std::chrono::milliseconds timeout) override {
    return free_.try_acquire_for(timeout);
  }
  void rr_monitor_exit() override { free_.release(); }

  Gate* gate = nullptr;

 private:
  const std::shared_ptr<Lives> lives_;
  std::binary_semaphore free_{1};
};

// Its `child` is each client's own; so are its children by number.
class Sessions : public Counter {
 public:
  std::shared_ptr<Skeleton> get_child() override {
    auto mine = std::make_shared<Mine>(lives);
    mine->gate = gate;
    const std::lock_guard lock(mutex_);
    found[ServiceContext::current_client()] = mine;
    return per_client(std::move(mine));
  }
  std::shared_ptr<Skeleton> get_by_number(std::int32_t /*index*/) override { return get_child(); }

  const std::shared_ptr<Lives> lives = std::make_shared<Lives>();
  Gate* gate = nullptr;
  std::map<std::uint32_t, std::weak_ptr<Mine>> found;

 private:
  std::mutex mutex_;
};

struct SessionsPair : Pair {
  explicit SessionsPair(ServiceOptions options = {})
      : SessionsPair(std::make_shared<Sessions>(), std::move(options)) {}
  SessionsPair(std::shared_ptr<Sessions> offered, ServiceOptions options)
      : Pair({}, {}, offered, std::move(options)), sessions(std::move(offered)) {}
  // The number of the client that has connected last.
  [[nodiscard]] std::uint32_t last_client() const { return service->clients().back().endpoint; }
  const std::shared_ptr<Sessions> sessions;
};

TEST(SessionObjects, AreOnePathAndAnObjectForEachClient) {
  SessionsPair pair;
  auto first = pair.connect();
  auto second = pair.connect();
  const auto mine = first->get_child();
  const auto yours = second->get_child();
  EXPECT_EQ(mine->rr_path(), yours->rr_path());
  mine->set_value(1);
  yours->set_value(2);
  EXPECT_EQ(mine->get_value(), 1);
  EXPECT_EQ(yours->get_value(), 2);
  EXPECT_EQ(first->get_child()->get_value(), 1);
  EXPECT_EQ(pair.sessions->lives->count("made"), 2U);
  first->get_by_number(3)->set_value(5);
  second->get_by_number(3)->set_value(6);
  EXPECT_EQ(first->get_by_number(3)->get_value(), 5);
  // The others are everybody's.
  first->get_by_name("shared")->set_value(7);
  EXPECT_EQ(second->get_by_name("shared")->get_value(), 7);
}

TEST(SessionObjects, WhatLiesBelowIsTheClientsOwnToo) {
  SessionsPair pair;
  auto first = pair.connect();
  auto second = pair.connect();
  const auto mine = first->get_child()->get_child();
  const auto yours = second->get_child()->get_child();
  mine->set_value(1);
  yours->set_value(2);
  EXPECT_EQ(mine->get_value(), 1);
  EXPECT_EQ(pair.sessions->lives->count("made"), 4U);
}

TEST(SessionObjects, SendTheirEventsToTheirClientOnly) {
  SessionsPair pair;
  auto first = pair.connect();
  auto second = pair.connect();
  const auto mine = first->get_child();
  const auto yours = second->get_child();
  std::atomic<int> to_first{0};
  std::atomic<int> to_second{0};
  auto one = mine->ticked().connect([&](std::int32_t, const std::string&) { ++to_first; });
  auto other = yours->ticked().connect([&](std::int32_t, const std::string&) { ++to_second; });
  mine->fire(5);
  yours->fire(1);  // comes behind whatever the first has caused
  EXPECT_TRUE(eventually([&] { return to_first == 5 && to_second == 1; }));
  second->add(1, 2);
  EXPECT_EQ(to_second, 1);
}

TEST(SessionObjects, AreReleasedWhenTheirClientLeaves) {
  const auto sessions = std::make_shared<Sessions>();
  ServiceOptions options;
  options.on_client_disconnected = [lives = sessions->lives](const ServiceClient&) {
    lives->note("left");
  };
  SessionsPair pair(sessions, options);
  auto second = pair.connect();
  const auto yours = second->get_child();
  yours->set_value(2);
  {
    auto first = pair.connect();
    first->get_child()->get_child();
  }
  Lives& lives = *sessions->lives;
  EXPECT_TRUE(eventually([&] { return lives.count("left") == 1; }));
  const std::string path = yours->rr_path();
  EXPECT_EQ(lives.count("released " + path), 1U);
  EXPECT_EQ(lives.count("released " + path + ".child"), 1U);
  EXPECT_EQ(lives.count("gone"), 2U);
  EXPECT_EQ(lives.notes().back(), "left");
  EXPECT_THAT(lives.threads(), ::testing::Each(::testing::Ne(std::this_thread::get_id())));
  EXPECT_EQ(yours->get_value(), 2);
}

TEST(SessionObjects, AreReleasedForOneClientOrForAll) {
  SessionsPair pair;
  std::atomic<int> told_first{0};
  std::atomic<int> told_second{0};
  auto first = pair.connect({.on_path_released = [&](const std::string&) { ++told_first; }});
  const std::uint32_t number = pair.last_client();
  auto second = pair.connect({.on_path_released = [&](const std::string&) { ++told_second; }});
  const auto mine = first->get_child();
  const auto yours = second->get_child();
  mine->set_value(1);
  yours->set_value(2);
  yours->get_child();
  const std::string path = yours->rr_path();
  pair.service->release_path(path, number);
  EXPECT_TRUE(eventually([&] { return told_first == 1; }));
  EXPECT_TRUE(eventually([&] { return pair.sessions->lives->count("gone") == 1; }));
  EXPECT_EQ(first->get_child()->get_value(), 0);
  EXPECT_EQ(yours->get_value(), 2);
  pair.service->release_path(path);
  EXPECT_TRUE(eventually([&] { return told_first == 2 && told_second == 1; }));
  EXPECT_TRUE(eventually([&] { return pair.sessions->lives->count("gone") == 4; }));
  EXPECT_EQ(second->get_child()->get_value(), 0);
}

TEST(SessionObjects, ThatAreNotThereCannotBeReleased) {
  SessionsPair pair;
  auto first = pair.connect();
  const std::uint32_t number = pair.last_client();
  auto second = pair.connect();
  second->get_child();
  first->get_by_name("shared")->get_value();
  const auto code = [&](const std::string& path, std::uint32_t client) {
    return error_of([&] { pair.service->release_path(path, client); }).code();
  };
  EXPECT_EQ(code("counter.child", number), ErrorCode::service_error);
  EXPECT_EQ(code("counter.by_name[shared]", number), ErrorCode::service_error);
  EXPECT_EQ(code("counter.child", 0), ErrorCode::service_error);
  EXPECT_EQ(code("counter", number), ErrorCode::invalid_operation);
  EXPECT_EQ(code("counter.child", pair.last_client()), ErrorCode::none);
}

TEST(SessionObjects, AreLockedForNobodyElse) {
  const auto users = std::make_shared<PasswordUsers>(
      "alice 6384e2b2184bcbf58eccf10ca7a6563c objectlock\n"
      "bob 9f9d51bc70ef21ca5c14f307980a29d8 objectlock\n");
  SessionsPair pair(ServiceOptions{.users = users});
  auto alice =
      pair.connect({.username = "alice", .credentials = {{"password", VarValue("alice")}}});
  auto bob = pair.connect({.username = "bob", .credentials = {{"password", VarValue("bob")}}});
  const auto hers = alice->get_child();
  const auto his = bob->get_child();
  const auto code = [](const std::function<void()>& what) { return error_of(what).code(); };
  lock(*hers);
  EXPECT_EQ(his->get_value(), 0);
  EXPECT_EQ(code([&] { lock(*his); }), ErrorCode::none);
  EXPECT_EQ(code([&] { lock(*hers); }), ErrorCode::object_locked_error);
  EXPECT_EQ(code([&] { lock(*alice); }), ErrorCode::object_locked_error);  // his lies below
  unlock(*hers);
  EXPECT_EQ(code([&] { lock(*his); }), ErrorCode::object_locked_error);  // hers is not his
  unlock(*his);
  lock(*alice);  // the root, and so all below
  EXPECT_EQ(code([&] { his->get_value(); }), ErrorCode::object_locked_error);
  EXPECT_EQ(hers->get_value(), 0);
}

TEST(SessionObjects, HaveAMonitorEach) {
  SessionsPair pair;
  auto first = pair.connect();
  auto second = pair.connect();
  const auto mine = first->get_child();
  const auto yours = second->get_child();
  const MonitorLock in_mine(*mine, 1000ms);
  const MonitorLock in_yours(*yours, 1000ms);
  EXPECT_EQ(mine->get_value(), 0);
  EXPECT_EQ(yours->get_value(), 0);
}

TEST(SessionObjects, LiveUntilTheRequestHasEndedInWhichTheirClientDrops) {
  const auto sessions = std::make_shared<Sessions>();
  Gate gate;
  sessions->gate = &gate;
  SessionsPair pair(sessions, {});
  auto first = pair.connect();
  const std::uint32_t number = pair.last_client();
  const auto mine = first->get_child();
  auto busy = std::async(std::launch::async, [&] { return error_of([&] { mine->reset(); }); });
  ASSERT_TRUE(gate.has_entered());
  first.close();
  EXPECT_NE(busy.get().code(), ErrorCode::none);
  pair.service->disconnect(number);
  EXPECT_TRUE(pair.service->clients().empty());
  EXPECT_FALSE(sessions->found[number].expired());
  EXPECT_EQ(sessions->lives->notes(), std::vector<std::string>{"made"});
  gate.open();
  EXPECT_TRUE(eventually([&] { return sessions->lives->count("gone") == 1; }));
  EXPECT_THAT(sessions->lives->notes(), ElementsAre("made", "released counter.child", "gone"));
}

TEST(SessionObjects, AreReleasedWhenTheServiceCloses) {
  SessionsPair pair;
  auto first = pair.connect();
  auto second = pair.connect();
  first->get_child();
  second->get_child();
  pair.service->close();
  EXPECT_TRUE(eventually([&] { return pair.sessions->lives->count("gone") == 2; }));
  EXPECT_EQ(pair.sessions->lives->count("released counter.child"), 2U);
}

TEST(SessionObjects, GoWithTheNodeAtTheLatest) {
  std::shared_ptr<Lives> lives;
  {
    SessionsPair pair;
    lives = pair.sessions->lives;
    auto first = pair.connect();
    first->get_child();
    pair.server.shutdown();
    EXPECT_EQ(lives->count("released counter.child"), 1U);
  }
  EXPECT_EQ(lives->count("gone"), 1U);
}

TEST(SessionObjects, AskTheirOwnClientBackAndKeepItsGenerators) {
  class Root : public Board {
   public:
    std::shared_ptr<Skeleton> get_child() override {
      auto own = std::make_shared<Board>();
      own->held = token;
      own->on_run = [board = own.get()](const std::string&) {
        return board->sum(ServiceContext::current_client(), 1, 2);
      };
      return per_client(std::move(own));
    }
    std::shared_ptr<int> token = std::make_shared<int>();
  };
  const auto root = std::make_shared<Root>();
  BoardPair pair;
  pair.server.register_service("root", root);
  const auto connect = [&] {
    return pair.client.connect<BoardStub>("rr+tcp://127.0.0.1:" + std::to_string(pair.port) +
                                          "/?service=root");
  };
  auto first = connect();
  auto second = connect();
  const auto mine = first->get_child();
  const auto yours = second->get_child();
  mine->sum().set([](std::int32_t a, std::int32_t b) { return a + b; });
  yours->sum().set([](std::int32_t a, std::int32_t b) { return 10 * (a + b); });
  EXPECT_EQ(mine->run(""), 3);
  EXPECT_EQ(yours->run(""), 30);
  auto numbers = mine->count_to(3);
  EXPECT_EQ(numbers.next(), 1);
  first.close();
  EXPECT_TRUE(eventually([&] { return root->token.use_count() == 2; }));  // and second's
  EXPECT_EQ(yours->run(""), 30);
}

TEST(SessionObjects, HaveWiresOfTheirOwn) {
  class Root : public Wired {
   public:
    std::shared_ptr<Skeleton> rr_child(std::size_t, const ObjectIndex&) override {
      const auto own = std::make_shared<Wired>();
      made.push_back(own);
      return per_client(own);
    }
    std::vector<std::shared_ptr<Wired>> made;
  };
  const auto root = std::make_shared<Root>();
  WiredPair pair;
  pair.server.register_service("root", root);
  const std::string url = "rr+tcp://127.0.0.1:" + std::to_string(pair.port) + "/?service=root";
  auto first = pair.client.connect<WiredStub>(url);
  auto second = pair.client.connect<WiredStub>(url);
  const auto my_child = first->get_child("a");
  const auto your_child = second->get_child("a");
  auto mine = my_child->level().connect();
  auto yours = your_child->level().connect();
  ASSERT_EQ(root->made.size(), 2U);
  root->made[0]->level().set_in(1);
  root->made[1]->level().set_in(2);
  ASSERT_TRUE(mine.wait_in(20000ms));
  ASSERT_TRUE(yours.wait_in(20000ms));
  EXPECT_EQ(mine.in(), 1);
  EXPECT_EQ(yours.in(), 2);
  EXPECT_EQ(root->made[0]->level().connection_count(), 1U);
  first.close();
  EXPECT_TRUE(eventually([&] { return root->made[0].use_count() == 1; }));
  EXPECT_EQ(root->made[0]->level().connection_count(), 0U);
  EXPECT_TRUE(yours.is_open());
}

TEST(SessionObjects, OfManyClientsComeAndGo) {
  SessionsPair pair;
  constexpr int rounds = 10;
  std::vector<std::thread> threads;
  std::atomic<int> wrong{0};
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < rounds; ++i) {
        auto counter = pair.connect();
        const auto mine = counter->get_child();
        const double value = 100 * t + i;
        mine->set_value(value);
        mine->get_child()->set_value(-value);
        if (counter->get_child()->get_value() != value) ++wrong;
        if (mine->get_child()->get_value() != -value) ++wrong;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
  Lives& lives = *pair.sessions->lives;
  EXPECT_TRUE(eventually([&] { return lives.count("gone") == lives.count("made"); }));
  EXPECT_EQ(lives.count("made"), 4U * rounds * 2);
}

}  // namespace
}  // namespace rr::testing
