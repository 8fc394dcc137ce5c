// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "rr/error.hpp"
#include "runtime/cpp/src/service/logins.hpp"

namespace rr::service {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::SizeIs;

struct Lines {
  std::mutex mutex;
  std::vector<std::string> all;

  Logins::Log log() {
    return [this](LogLevel level, std::string_view text) {
      const std::lock_guard lock(mutex);
      if (level == LogLevel::warning) all.emplace_back(text);
    };
  }
  std::vector<std::string> get() {
    const std::lock_guard lock(mutex);
    return all;
  }
};

template <class Holds>
bool eventually(const Holds& holds) {
  const auto deadline = std::chrono::steady_clock::now() + 20s;
  while (!holds()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(1ms);
  }
  return true;
}

User refuse() { throw Error(ErrorCode::authentication_error, "wrong"); }

// An attempt whose end can be waited for.
struct Tried {
  std::shared_ptr<Logins::Attempt> attempt;
  std::future<void> finished;

  [[nodiscard]] bool is_finished() const {
    return finished.wait_for(0ms) == std::future_status::ready;
  }
  std::string refusal() {
    finished.wait();
    try {
      if (attempt->refusal) std::rethrow_exception(attempt->refusal);
    } catch (const Error& error) {
      return error.message();
    }
    return {};
  }
};

Tried start(Logins& logins, const std::string& address, std::function<User()> check,
            unsigned failures = 0, const std::string& user = "alice") {
  auto promise = std::make_shared<std::promise<void>>();
  Tried tried;
  tried.finished = promise->get_future();
  tried.attempt = logins.add({.address = address,
                              .user = user,
                              .failures = failures,
                              .check = std::move(check),
                              .on_finished = [promise] { promise->set_value(); }});
  return tried;
}

// Lets nothing through until it is opened.
struct Door {
  std::promise<void> opened;
  std::shared_future<void> is_open = opened.get_future().share();
  std::atomic<int> entered{0};

  auto check() {
    return [this]() -> User {
      ++entered;
      is_open.wait();
      return {.name = "alice"};
    };
  }
};

TEST(Logins, DelaysGrowWithFailuresUpToALimit) {
  const LoginOptions options;
  const auto delay = [&](unsigned of_connection, unsigned of_address) {
    return Logins::delay(options, of_connection, of_address).count();
  };
  EXPECT_EQ(delay(0, 0), 0);
  EXPECT_EQ(delay(1, 0), 250);
  EXPECT_EQ(delay(2, 0), 500);
  EXPECT_EQ(delay(4, 0), 2000);
  EXPECT_EQ(delay(6, 0), 8000);
  EXPECT_EQ(delay(4'000'000'000, 0), 8000);
  EXPECT_EQ(delay(0, 4), 0);  // several clients may be behind an address
  EXPECT_EQ(delay(0, 5), 250);
  EXPECT_EQ(delay(0, 1000), 8000);
  const LoginOptions endless{.first_delay = std::chrono::milliseconds::max(),
                             .max_delay = std::chrono::milliseconds::max()};
  EXPECT_GT(Logins::delay(endless, 3, 0).count(), 0);
}

TEST(Logins, SayWhoCameInAndWhy) {
  Lines lines;
  Logins logins({}, lines.log());
  Tried in = start(logins, "10.0.0.1", [] { return User{.name = "alice"}; });
  EXPECT_EQ(in.refusal(), "");
  EXPECT_EQ(in.attempt->user->name, "alice");
  Tried out = start(logins, "10.0.0.2", refuse, 0, "b\033[2Job`");
  EXPECT_EQ(out.refusal(), "wrong");
  EXPECT_EQ(out.attempt->user, nullptr);
  Tried odd = start(logins, "10.0.0.3", []() -> User { throw 42; });
  odd.finished.wait();
  EXPECT_NE(odd.attempt->refusal, nullptr);
  const auto all = lines.get();
  ASSERT_THAT(all, SizeIs(2));
  EXPECT_EQ(all[0], "`b\\x1b[2Job\\x60` from 10.0.0.2 is not logged in: wrong");
  EXPECT_THAT(all[1], HasSubstr("10.0.0.3"));
}

// Of a thread: says when it ends.
struct AtItsEnd {
  explicit AtItsEnd(std::atomic<bool>& flag) : is_over(flag) {}
  ~AtItsEnd() { is_over = true; }
  AtItsEnd(const AtItsEnd&) = delete;
  AtItsEnd& operator=(const AtItsEnd&) = delete;

  std::atomic<bool>& is_over;
};

TEST(Logins, AThreadEndsWhenItHasHadNothingToDo) {
  static std::atomic<bool> is_over;
  is_over = false;
  Lines lines;
  Logins logins({}, lines.log(), 20ms);
  EXPECT_EQ(start(logins, "10.0.0.1",
                  [] {
                    thread_local const AtItsEnd end(is_over);
                    return User{.name = "alice"};
                  })
                .refusal(),
            "");
  EXPECT_TRUE(eventually([&] { return is_over.load(); }));
  EXPECT_EQ(start(logins, "10.0.0.1", [] { return User{.name = "bob"}; }).refusal(), "");
}

TEST(Logins, NamesInTheLogAreShort) {
  EXPECT_EQ(printable_name(std::string(1000, 'x')), std::string(64, 'x') + "...");
  EXPECT_EQ(printable_name("\xc3\xa9"), "\\xc3\\xa9");
}

TEST(Logins, RunOnAThreadOfTheirOwn) {
  Lines lines;
  Logins logins({}, lines.log());
  std::atomic<bool> is_own{false};
  Tried tried = start(logins, "10.0.0.1", [&]() -> User {
    is_own = logins.is_own_thread();
    return {};
  });
  tried.finished.wait();
  EXPECT_TRUE(is_own);
  EXPECT_FALSE(logins.is_own_thread());
}

TEST(Logins, WhatDoesNotFitIntoTheQueueIsRefused) {
  Lines lines;
  Logins logins({.threads = 1, .queue_limit = 3}, lines.log());
  Door door;
  std::vector<Tried> tried;
  tried.push_back(start(logins, "10.0.0.1", door.check()));
  ASSERT_TRUE(eventually([&] { return door.entered == 1; }));
  for (int i = 0; i < 3; ++i) tried.push_back(start(logins, "10.0.0.1", door.check()));
  EXPECT_THAT(start(logins, "10.0.0.1", door.check()).refusal(), HasSubstr("busy"));
  for (const Tried& one : tried) EXPECT_FALSE(one.is_finished());
  door.opened.set_value();
  for (Tried& one : tried) EXPECT_EQ(one.refusal(), "");
}

TEST(Logins, AddressesShareTheQueueAndTakeTurns) {
  Lines lines;
  Logins logins({.threads = 1, .queue_limit = 8}, lines.log());
  Door door;
  std::vector<Tried> attack;
  attack.push_back(start(logins, "10.0.0.1", door.check()));
  ASSERT_TRUE(eventually([&] { return door.entered == 1; }));
  std::mutex mutex;
  std::vector<char> order;
  const auto note = [&](char who) {
    return [&, who]() -> User {
      const std::lock_guard lock(mutex);
      order.push_back(who);
      return {};
    };
  };
  for (int i = 0; i < 8; ++i) attack.push_back(start(logins, "10.0.0.1", note('a')));
  Tried honest = start(logins, "10.0.0.2", note('h'));
  EXPECT_THAT(attack.back().refusal(), HasSubstr("busy"));  // has made room
  door.opened.set_value();
  EXPECT_EQ(honest.refusal(), "");
  for (Tried& one : attack) one.finished.wait();
  ASSERT_EQ(order.size(), 8U);
  EXPECT_TRUE(order[0] == 'h' || order[1] == 'h');
}

TEST(Logins, AnAddressWaitsAfterFailuresAndOthersDoNot) {
  Lines lines;
  Logins logins({.threads = 1, .first_delay = 1h, .max_delay = 1h}, lines.log());
  for (int i = 0; i < 5; ++i) start(logins, "10.0.0.1", refuse).finished.wait();
  Tried late = start(logins, "10.0.0.1", [] { return User{}; });
  Tried other = start(logins, "10.0.0.2", [] { return User{}; });
  EXPECT_EQ(other.refusal(), "");
  Tried same_connection = start(
      logins, "10.0.0.2", [] { return User{}; }, 1);
  EXPECT_FALSE(late.is_finished());
  EXPECT_FALSE(same_connection.is_finished());
  logins.cancel(late.attempt);
  EXPECT_EQ(late.finished.wait_for(20s), std::future_status::ready);
  logins.stop();
  EXPECT_THAT(same_connection.refusal(), HasSubstr("busy"));
}

TEST(Logins, FailuresAreForgotten) {
  Lines lines;
  Logins logins({.threads = 1, .first_delay = 1h, .max_delay = 1h, .memory = 50ms}, lines.log());
  for (int i = 0; i < 5; ++i) start(logins, "10.0.0.1", refuse).finished.wait();
  std::this_thread::sleep_for(60ms);
  EXPECT_EQ(start(logins, "10.0.0.1", [] { return User{}; }).refusal(), "");
}

TEST(Logins, OfAFloodOfAddressesABoundedNumberIsRemembered) {
  Lines lines;
  Logins logins({.threads = 1, .queue_limit = 10'000}, lines.log());
  std::vector<Tried> tried;
  for (int i = 0; i < 6000; ++i) {
    tried.push_back(start(logins, "address " + std::to_string(i), refuse));
  }
  for (Tried& one : tried) one.finished.wait();
  EXPECT_EQ(start(logins, "10.0.0.1", [] { return User{}; }).refusal(), "");
}

TEST(Logins, TenFailuresASecondAreLoggedAndTheRestIsCounted) {
  Lines lines;
  Logins logins({.threads = 1, .queue_limit = 1000, .first_delay = 0ms, .max_delay = 0ms},
                lines.log());
  std::vector<Tried> tried;
  for (int i = 0; i < 100; ++i) tried.push_back(start(logins, "10.0.0.1", refuse));
  for (Tried& one : tried) one.finished.wait();
  // The rest is told within a second or so even if nothing fails any more.
  const auto told = [&] {
    std::size_t count = 0;
    for (const std::string& line : lines.get()) {
      const bool is_rest = line.find("more logins have failed") != std::string::npos;
      count += is_rest ? static_cast<std::size_t>(std::stoul(line)) : 1;
    }
    return count;
  };
  EXPECT_TRUE(eventually([&] { return told() == 100; }));
  EXPECT_LT(lines.get().size(), 60U);
}

}  // namespace
}  // namespace rr::service
