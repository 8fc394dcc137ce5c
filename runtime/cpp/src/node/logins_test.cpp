// SPDX-License-Identifier: Apache-2.0
// Logging in while others try to: passwords are checked on threads of their own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/use_future.hpp>
#include <chrono>
#include <ctime>
#include <future>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "rr/users.hpp"
#include "runtime/cpp/src/node/testing/async_counter.hpp"
#include "runtime/cpp/src/node/testing/gate.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/raw_client.hpp"

namespace rr::testing {
namespace {

using boost::asio::use_future;
using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using Clock = std::chrono::steady_clock;

VarStringMap with_password(const std::string& password) { return {{"password", password}}; }

std::shared_ptr<PasswordUsers> alice() {
  static const std::string hash = PasswordUsers::hash("wonder land 1");
  return std::make_shared<PasswordUsers>("alice " + hash + " _\n");
}

struct Warnings {
  std::mutex mutex;
  std::vector<std::string> lines;
  auto log() {
    return [this](LogLevel level, std::string_view text) {
      const std::lock_guard lock(mutex);
      if (level == LogLevel::warning) lines.emplace_back(text);
    };
  }
  std::vector<std::string> all() {
    const std::lock_guard lock(mutex);
    return lines;
  }
};

// Users whose check waits until the test lets it go on.
class SlowUsers final : public Users {
 public:
  User authenticate(const std::string& name, const std::map<std::string, VarValue>& /*given*/,
                    const NodeId& /*node*/) const override {
    gate.pass();
    if (name == "odd") throw 42;
    return {.name = name};
  }
  mutable Gate gate;
};

RawClient::Elements login_as(const std::string& user, const std::string& password) {
  return [=](Writer& writer) {
    const VarStringMap credentials = with_password(password);
    type_of<VarStringMap>.write(writer, "credentials", &credentials);
    writer.string_element("username", user);
    return 2U;
  };
}

// What AuthenticateUser is answered with. The service may test the connection before, where the
// machine is busy.
RawClient::Answer log_in(RawClient& client, const std::string& user, const std::string& password) {
  client.send(EntryType::client_session_op_req, "counter", "AuthenticateUser",
              login_as(user, password));
  auto answer = client.receive(20'000).value();
  while (answer.type != EntryType::client_session_op_ret) answer = client.receive(20'000).value();
  return answer;
}

TEST(LoggingIn, HoldsUpNobodyElseHoweverLongItTakes) {
  const auto users = std::make_shared<SlowUsers>();
  Pair pair({}, {}, std::make_shared<Counter>(), {.users = users, .require_user = false});
  auto one = pair.connect();
  auto other = pair.connect();
  auto login =
      std::async(std::launch::async, [&] { one.authenticate("alice", with_password("slow")); });
  ASSERT_TRUE(users->gate.has_entered());
  // What the same session asks meanwhile comes after it, in order.
  auto first = one->async_add(1, 2, use_future);
  auto second = one->async_add(3, 4, use_future);
  for (int i = 0; i < 50; ++i) EXPECT_EQ(other->add(i, 1), i + 1);
  EXPECT_EQ(first.wait_for(0ms), std::future_status::timeout);
  users->gate.open();
  login.get();
  EXPECT_EQ(first.get(), 3);
  EXPECT_EQ(second.get(), 7);
  EXPECT_EQ(pair.service->clients().size(), 2U);
}

TEST(LoggingIn, MayTakeLongInConnectingToo) {
  const auto users = std::make_shared<SlowUsers>();
  Pair pair({}, {}, std::make_shared<Counter>(), {.users = users});
  auto connected = std::async(std::launch::async, [&] {
    return pair.connect({.username = "alice", .credentials = with_password("x")})->add(1, 2);
  });
  ASSERT_TRUE(users->gate.has_entered());
  EXPECT_EQ(code_of([&] { pair.connect(); }), ErrorCode::authentication_error);
  users->gate.open();
  EXPECT_EQ(connected.get(), 3);
  EXPECT_EQ(code_of([&] { pair.connect({.username = "odd", .credentials = with_password("x")}); }),
            ErrorCode::authentication_error);
}

TEST(LoggingIn, EndsWithItsClient) {
  const auto users = std::make_shared<SlowUsers>();
  Pair pair({.login = {.threads = 1}}, {}, std::make_shared<Counter>(),
            {.users = users, .require_user = false});
  auto blocking = pair.connect();
  auto login = blocking->async_add(0, 0, use_future);
  auto first = std::async(std::launch::async, [&] {
    return code_of([&] { blocking.authenticate("alice", with_password("x")); });
  });
  ASSERT_TRUE(users->gate.has_entered());
  {
    RawClient leaving(pair.server, "counter");
    leaving.send(EntryType::client_session_op_req, "counter", "AuthenticateUser",
                 login_as("bob", "x"));
    EXPECT_TRUE(eventually([&] { return pair.service->clients().size() == 2; }));
  }
  EXPECT_TRUE(eventually([&] { return pair.service->clients().size() == 1; }));
  users->gate.open();
  EXPECT_EQ(first.get(), ErrorCode::none);
  EXPECT_EQ(users->gate.entered(), 1);  // the other one was not looked at
}

TEST(LoggingIn, ANodeMayEndMeanwhile) {
  const auto users = std::make_shared<SlowUsers>();
  Pair pair({}, {}, std::make_shared<Counter>(), {.users = users, .require_user = false});
  auto client = pair.connect();
  auto login = std::async(std::launch::async, [&] {
    return code_of([&] { client.authenticate("alice", with_password("x")); });
  });
  ASSERT_TRUE(users->gate.has_entered());
  auto opener = std::async(std::launch::async, [&] {
    std::this_thread::sleep_for(50ms);
    users->gate.open();
  });
  pair.server.shutdown();
  EXPECT_EQ(login.get(), ErrorCode::connection_error);
}

TEST(LoggingIn, FailuresAreLoggedWithTheAddressAndTheName) {
  Warnings warnings;
  Pair pair({.log = warnings.log()}, {.client_offer = {.combined_connect = true}},
            std::make_shared<Counter>(), {.users = alice()});
  RawClient client(pair.server, "counter", "127.0.0.2");
  EXPECT_EQ(log_in(client, "al\nice", "wrong").error,
            static_cast<std::uint16_t>(ErrorCode::authentication_error));
  EXPECT_THAT(warnings.all(), Contains(AllOf(HasSubstr("`al\\x0aice`"), HasSubstr("127.0.0.2"),
                                             HasSubstr("Invalid username or password"))));
  const std::size_t before = warnings.all().size();
  EXPECT_EQ(
      code_of([&] { pair.connect({.username = "mallory", .credentials = with_password("x")}); }),
      ErrorCode::authentication_error);
  const auto all = warnings.all();
  ASSERT_GT(all.size(), before);
  EXPECT_THAT(all.back(), HasSubstr("`mallory`"));
}

TEST(LoggingIn, AConnectionIsClosedAfterAFewFailures) {
  Pair pair({.login = {.first_delay = 1ms, .max_failures = 3}}, {}, std::make_shared<Counter>(),
            {.users = alice()});
  RawClient client(pair.server, "counter");
  for (int i = 0; i < 3; ++i) EXPECT_NE(log_in(client, "alice", "wrong").error, 0) << i;
  EXPECT_TRUE(eventually([&] { return pair.service->clients().empty(); }));
  RawClient other(pair.server, "counter");
  EXPECT_NE(log_in(other, "alice", "wrong").error, 0);
  EXPECT_EQ(log_in(other, "alice", "wonder land 1").error, 0);
}

TEST(LoggingIn, TheNextAttemptWaitsAfterFailures) {
  Pair pair({.login = {.first_delay = 200ms}}, {}, std::make_shared<Counter>(), {.users = alice()});
  RawClient client(pair.server, "counter");
  const auto begin = Clock::now();
  EXPECT_NE(log_in(client, "alice", "wrong").error, 0);
  EXPECT_NE(log_in(client, "alice", "wrong").error, 0);
  EXPECT_EQ(log_in(client, "alice", "wonder land 1").error, 0);
  EXPECT_GE(Clock::now() - begin, 600ms);  // 200 and 400
}

// One message brings as many as 65,535 entries: each would be a guess.
TEST(LoggingIn, OneMessageBringsOneLogin) {
  class Counting final : public Users {
   public:
    User authenticate(const std::string& name, const std::map<std::string, VarValue>& /*given*/,
                      const NodeId& /*node*/) const override {
      ++count;
      return {.name = name};
    }
    mutable std::atomic<int> count{0};
  };
  const auto users = std::make_shared<Counting>();
  Pair pair({}, {}, std::make_shared<Counter>(), {.users = users});
  RawClient client(pair.server, "counter");
  std::vector<RawClient::Request> requests;
  for (std::uint32_t i = 0; i < 20; ++i) {
    requests.push_back({EntryType::client_session_op_req, "counter", "AuthenticateUser",
                        login_as("alice", "x"), i + 1});
  }
  client.send(requests);
  const auto answers = client.receive_all();
  ASSERT_THAT(answers, SizeIs(20));
  EXPECT_EQ(answers[0].error, 0);
  for (std::size_t i = 1; i < answers.size(); ++i) EXPECT_NE(answers[i].error, 0) << i;
  EXPECT_EQ(users->count, 1);
}

// A login that was checked for one service does not count for another of the same node.
TEST(LoggingIn, IsForTheServiceThatWasAsked) {
  Pair pair({}, {}, std::make_shared<Counter>(), {.users = alice()});
  const auto strict = std::make_shared<SlowUsers>();
  const Service other =
      pair.server.register_service("other", std::make_shared<Counter>(), {.users = alice()});
  RawClient client(pair.server, "counter");
  EXPECT_EQ(log_in(client, "alice", "wonder land 1").error, 0);
  RawClient stranger(pair.server, "other");
  EXPECT_NE(stranger.ask(EntryType::property_get_req, "other", "fixed").error, 0);
}

// The time of this thread, as others use the processor.
double cost_of(const std::function<void()>& work) {
  timespec begin{};
  timespec end{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &begin);
  work();
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &end);
  return static_cast<double>(end.tv_sec - begin.tv_sec) +
         1e-9 * static_cast<double>(end.tv_nsec - begin.tv_nsec);
}

TEST(PasswordUsers, UnknownUsersCostAsMuchAsKnownOnes) {
  const std::string hash = PasswordUsers::hash("x");
  // The first account is cheap: it must not stand for all the others.
  const PasswordUsers users("bob b177f56968fdfe39a41e06e419013440 _\nalice " + hash + " _\ncarol " +
                            hash + " _\ndave " + hash + " _\n");
  const auto cost = [&](const std::string& name) {
    std::vector<double> costs;
    for (int i = 0; i < 5; ++i) {
      costs.push_back(cost_of([&] {
        EXPECT_EQ(code_of([&] { (void)users.authenticate(name, with_password("wrong"), {}); }),
                  ErrorCode::authentication_error);
      }));
    }
    std::sort(costs.begin(), costs.end());
    return costs[2];
  };
  const double known = cost("alice");
  int dear = 0;
  for (int i = 0; i < 40; ++i) {
    const std::string name = "nobody" + std::to_string(i);
    const double unknown = cost_of([&] {
      EXPECT_NE(code_of([&] { (void)users.authenticate(name, with_password("wrong"), {}); }),
                ErrorCode::none);
    });
    if (unknown > known / 3) ++dear;
  }
  // Three of four accounts are as dear; so are about as many of those that do not exist.
  EXPECT_GT(dear, 15);
  EXPECT_GT(cost("nobody"), 0);
}

// Guesses of many connections from one address, over and over.
class Guessing {
 public:
  Guessing(Node& node, int connections, const char* from) {
    constexpr int threads = 10;
    for (int i = 0; i < threads; ++i) {
      threads_.emplace_back([&node, this, from, count = connections / threads] {
        std::vector<std::unique_ptr<RawClient>> clients(static_cast<std::size_t>(count));
        for (auto& client : clients) start(node, from, client);
        for (std::size_t k = 0; !is_over_; k = (k + 1) % clients.size()) {
          try {
            if (!clients[k]) start(node, from, clients[k]);
            if (!clients[k]->receive_all(1).empty()) {
              ++guesses;
              ask(*clients[k]);
            }
          } catch (const std::exception&) {
            clients[k] = nullptr;  // it has been closed
          }
        }
      });
    }
  }
  ~Guessing() {
    is_over_ = true;
    for (std::thread& thread : threads_) thread.join();
  }
  std::atomic<int> guesses{0};

 private:
  static void ask(RawClient& client) {
    client.send(EntryType::client_session_op_req, "counter", "AuthenticateUser",
                login_as("alice", "guess"));
  }
  static void start(Node& node, const char* from, std::unique_ptr<RawClient>& client) {
    try {
      client = std::make_unique<RawClient>(node, "counter", from);
      ask(*client);
    } catch (const std::exception&) {
      client = nullptr;
    }
  }

  std::atomic<bool> is_over_{false};
  std::vector<std::thread> threads_;
};

TEST(LoggingIn, TwoHundredConnectionsThatGuessHoldUpNobody) {
  Pair pair({}, {}, std::make_shared<Counter>(), {.users = alice()});
  const Service open = pair.server.register_service("open", std::make_shared<Counter>());
  auto probe = pair.client.connect<CounterStub>(pair.url("open"));
  const auto p99 = [&] {
    std::vector<Clock::duration> times;
    for (int i = 0; i < 400; ++i) {
      const auto begin = Clock::now();
      probe->add(1, 2);
      times.push_back(Clock::now() - begin);
      std::this_thread::sleep_for(1ms);
    }
    std::sort(times.begin(), times.end());
    return times[times.size() * 99 / 100];
  };
  const auto idle = p99();
  Guessing attack(pair.server, 200, "127.0.0.2");
  ASSERT_TRUE(eventually([&] { return attack.guesses > 20; }));
  // One processor may be busy with the attackers themselves.
  const auto busy = p99();
  const auto text = [](Clock::duration time) {
    return std::to_string(std::chrono::duration_cast<std::chrono::microseconds>(time).count());
  };
  RecordProperty("p99_us_idle", text(idle));
  RecordProperty("p99_us_busy", text(busy));
  EXPECT_LT(busy, std::max<Clock::duration>(10 * idle, 1s));
  // Someone else logs in meanwhile.
  RawClient honest(pair.server, "counter", "127.0.0.3");
  const auto begin = Clock::now();
  EXPECT_EQ(log_in(honest, "alice", "wonder land 1").error, 0);
  const auto login = Clock::now() - begin;
  RecordProperty("honest_login_us", text(login));
  EXPECT_LT(login, 5s);
}

}  // namespace
}  // namespace rr::testing
