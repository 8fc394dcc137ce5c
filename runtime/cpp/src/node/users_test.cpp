// SPDX-License-Identifier: Apache-2.0
#include "rr/users.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstdio>
#include <fstream>
#include <mutex>

#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::testing {
namespace {

using ::testing::AnyOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

VarStringMap with_password(const std::string& password) { return {{"password", password}}; }

ConnectOptions as(const std::string& user, const std::string& password) {
  return {.username = user, .credentials = with_password(password)};
}

std::shared_ptr<PasswordUsers> two_users() {
  static const std::string hash = PasswordUsers::hash("wonder land 1");
  return std::make_shared<PasswordUsers>(
      "# name, hash, privileges\n"
      "alice " +
      hash +
      " objectlock\n"
      "\n"
      "bob b177f56968fdfe39a41e06e419013440 _\r\n");  // of builder-2
}

struct PairWithUsers : Pair {
  explicit PairWithUsers(bool require_user = true, std::shared_ptr<Counter> offered = nullptr)
      : Pair({}, {}, offered ? std::move(offered) : std::make_shared<Counter>(),
             {.users = two_users(), .require_user = require_user}) {}
};

TEST(Users, APasswordOpensTheServiceAndNothingElseDoes) {
  PairWithUsers pair;
  auto alice = pair.connect(as("alice", "wonder land 1"));
  EXPECT_EQ(alice->get_fixed(), 42.125);
  auto bob = pair.connect(as("bob", "builder-2"));
  EXPECT_EQ(bob->get_fixed(), 42.125);
  const auto refused = ErrorCode::authentication_error;
  EXPECT_EQ(code_of([&] { pair.connect(as("alice", "wrong")); }), refused);
  EXPECT_EQ(code_of([&] { pair.connect(as("alice", "")); }), refused);
  EXPECT_EQ(code_of([&] { pair.connect(as("alice", "builder-2")); }), refused);
  EXPECT_EQ(code_of([&] { pair.connect(as("mallory", "wonder land 1")); }), refused);
  EXPECT_EQ(code_of([&] { pair.connect(as("bob", std::string("builder-2\0x", 11))); }), refused);
  EXPECT_EQ(code_of([&] { pair.connect(as("bob", std::string(5000, 'x'))); }), refused);
  EXPECT_EQ(code_of([&] {
              pair.connect({.username = "bob", .credentials = {{"pin", 5}}});
            }),
            refused);
  EXPECT_EQ(code_of([&] {
              pair.connect({.username = "bob", .credentials = {{"password", 5}}});
            }),
            refused);
  EXPECT_EQ(code_of([&] { pair.connect(); }), refused);
  EXPECT_TRUE(eventually([&] { return pair.service->clients().size() == 2; }));
}

TEST(Users, ASessionConnectedInStepsLogsInAtItsEnd) {
  Pair pair({}, {.client_offer = {.combined_connect = false}}, std::make_shared<Counter>(),
            {.users = two_users()});
  auto alice = pair.connect(as("alice", "wonder land 1"));
  EXPECT_EQ(alice->get_fixed(), 42.125);
  EXPECT_EQ(code_of([&] { pair.connect(as("alice", "wrong")); }), ErrorCode::authentication_error);
  auto nobody = pair.connect();
  EXPECT_EQ(code_of([&] { nobody->get_fixed(); }), ErrorCode::authentication_error);
  EXPECT_EQ(code_of([&] { nobody->get_child(); }), ErrorCode::authentication_error);
  EXPECT_THAT(nobody.fetch_attributes(), IsEmpty());
}

TEST(Users, LogInAndOutDuringASession) {
  PairWithUsers pair;
  auto client = pair.connect(as("alice", "wonder land 1"));
  EXPECT_EQ(code_of([&] { client.authenticate("bob", with_password("nope")); }),
            ErrorCode::authentication_error);
  EXPECT_EQ(pair.service->clients().front().user, "alice");
  client.authenticate("bob", with_password("builder-2"));
  EXPECT_EQ(pair.service->clients().front().user, "bob");
  EXPECT_EQ(client->get_fixed(), 42.125);
  client.logout();
  EXPECT_EQ(pair.service->clients().front().user, "");
  EXPECT_EQ(code_of([&] { client->get_fixed(); }), ErrorCode::authentication_error);
  client.logout();
  client.authenticate("alice", with_password("wonder land 1"));
  EXPECT_EQ(client->get_fixed(), 42.125);
}

TEST(Users, AServiceThatNeedsNoneRefusesThemInConnecting) {
  Pair open;
  EXPECT_EQ(code_of([&] { open.connect(as("alice", "wonder land 1")); }),
            ErrorCode::authentication_error);
  auto nobody = open.connect();
  EXPECT_EQ(code_of([&] { nobody.authenticate("alice", with_password("x")); }),
            ErrorCode::invalid_operation);
  EXPECT_EQ(code_of([&] { nobody.logout(); }), ErrorCode::invalid_operation);

  PairWithUsers optional(false);
  EXPECT_EQ(code_of([&] { optional.connect(as("alice", "wonder land 1")); }),
            ErrorCode::authentication_error);
  auto client = optional.connect();
  EXPECT_EQ(client->get_fixed(), 42.125);
  client.authenticate("alice", with_password("wonder land 1"));
  EXPECT_EQ(optional.service->clients().front().user, "alice");
}

TEST(Users, HandlersKnowWhoCalls) {
  class Asking : public Counter {
   public:
    std::string get_name() override {
      const auto user = ServiceContext::current_user();
      return user ? user->name + (user->has(lock_privilege) ? "+" : "-") : "nobody";
    }
  };
  PairWithUsers pair(false, std::make_shared<Asking>());
  auto client = pair.connect();
  EXPECT_EQ(client->get_name(), "nobody");
  client.authenticate("alice", with_password("wonder land 1"));
  EXPECT_EQ(client->get_name(), "alice+");
  client.authenticate("bob", with_password("builder-2"));
  EXPECT_EQ(client->get_name(), "bob-");
  EXPECT_EQ(ServiceContext::current_user(), nullptr);
}

TEST(Users, EventsGoToUsersOnly) {
  Pair pair({}, {.client_offer = {.combined_connect = false}}, std::make_shared<Counter>(),
            {.users = two_users()});
  auto alice = pair.connect(as("alice", "wonder land 1"));
  auto nobody = pair.connect();
  std::atomic<int> heard{0};
  std::atomic<int> overheard{0};
  const Subscription one =
      alice->ticked().connect([&](std::int32_t, const std::string&) { ++heard; });
  const Subscription other =
      nobody->ticked().connect([&](std::int32_t, const std::string&) { ++overheard; });
  alice->fire(3);
  EXPECT_TRUE(eventually([&] { return heard == 3; }));
  nobody.authenticate("bob", with_password("builder-2"));
  alice->fire(2);
  EXPECT_TRUE(eventually([&] { return heard == 5 && overheard == 2; }));
}

TEST(Users, AnAuthenticatorOfTheProgramsOwn) {
  class Tokens final : public Users {
   public:
    [[nodiscard]] User authenticate(const std::string& name,
                                    const std::map<std::string, VarValue>& credentials,
                                    const NodeId& node) const override {
      if (name == "broken") throw std::runtime_error("no data base");
      if (credentials.at("token").number<std::int32_t>() != 7 || node != expected) {
        throw Error(ErrorCode::authentication_error, "no such token");
      }
      return {name, {"paint"}};
    }
    NodeId expected;
  };
  auto tokens = std::make_shared<Tokens>();
  Pair pair({}, {}, std::make_shared<Counter>(), {.users = tokens});
  tokens->expected = pair.client.id();
  const auto with = [](const std::string& name, std::int32_t token) {
    return ConnectOptions{.username = name, .credentials = {{"token", token}}};
  };
  auto client = pair.connect(with("carol", 7));
  EXPECT_EQ(client->get_fixed(), 42.125);
  EXPECT_EQ(code_of([&] { pair.connect(with("carol", 8)); }), ErrorCode::authentication_error);
  EXPECT_EQ(code_of([&] { pair.connect(with("broken", 7)); }), ErrorCode::authentication_error);
  EXPECT_EQ(code_of([&] { client.authenticate("broken", {}); }), ErrorCode::remote_error);
}

TEST(Users, UnsaltedPasswordsAreWarnedAbout) {
  std::mutex mutex;
  std::vector<std::string> warnings;
  Node node({.log = [&](LogLevel level, std::string_view text) {
    const std::lock_guard lock(mutex);
    if (level == LogLevel::warning) warnings.emplace_back(text);
  }});
  node.register_service("counter", std::make_shared<Counter>(), {.users = two_users()});
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("`counter`: the password of user `bob`")));
}

TEST(PasswordUsers, HashesAreSaltedAndOfTheModernKind) {
  const std::string one = PasswordUsers::hash("secret");
  const std::string other = PasswordUsers::hash("secret");
  EXPECT_THAT(one, AnyOf(StartsWith("$y$"), StartsWith("$6$rounds=")));  // as the system can
  EXPECT_NE(one, other);
  const PasswordUsers users("a " + one + " x,objectlockoverride\nb " + other + " _\n");
  EXPECT_THAT(users.authenticate("a", with_password("secret"), {}).privileges,
              ElementsAre("x", "objectlockoverride"));
  EXPECT_THAT(users.authenticate("b", with_password("secret"), {}).privileges, IsEmpty());
  EXPECT_EQ(code_of([&] { (void)users.authenticate("a", with_password("Secret"), {}); }),
            ErrorCode::authentication_error);
  EXPECT_THAT(users.warnings(), IsEmpty());
  EXPECT_EQ(code_of([] { PasswordUsers::hash(std::string("a\0b", 3)); }),
            ErrorCode::invalid_argument);
  EXPECT_EQ(code_of([] { PasswordUsers::hash(std::string(512, 'x')); }),
            ErrorCode::invalid_argument);
}

TEST(PasswordUsers, MayComeFromCertainNodesOnly) {
  const NodeId here = NodeId::random();
  const NodeId there = NodeId::random();
  const PasswordUsers users("u 5ebe2294ecd0e0f08eab7690d2a6ee69 _ " + here.text_with_braces() +
                            "," + there.text() + "\n");  // of secret
  EXPECT_EQ(users.authenticate("u", with_password("secret"), here).name, "u");
  EXPECT_EQ(users.authenticate("u", with_password("secret"), there).name, "u");
  EXPECT_EQ(
      code_of([&] { (void)users.authenticate("u", with_password("secret"), NodeId::random()); }),
      ErrorCode::authentication_error);
}

TEST(PasswordUsers, WhatIsWrongIsToldWithItsLine) {
  const std::string hash = "5ebe2294ecd0e0f08eab7690d2a6ee69";
  const auto message = [](const std::string& text) {
    const Error error = error_of([&] { const PasswordUsers users(text); });
    EXPECT_EQ(error.code(), ErrorCode::invalid_configuration) << text;
    return error.message();
  };
  EXPECT_THAT(message("u " + hash + " _\nv plain _\n"), HasSubstr("line 2"));
  EXPECT_THAT(message("u\n"), HasSubstr("hash"));
  EXPECT_THAT(message("u $nosuch$abc _\n"), HasSubstr("hash"));
  EXPECT_THAT(message("u " + hash + "\n"), HasSubstr("privileges"));
  EXPECT_THAT(message("u " + hash + " _ nowhere\n"), HasSubstr("node ids"));
  EXPECT_THAT(message("u " + hash + " _ {} x\n"), HasSubstr("line 1"));
  EXPECT_THAT(message("u " + hash + " _\n\nu " + hash + " _"), HasSubstr("line 3"));
  EXPECT_EQ(code_of([] { PasswordUsers::from_file("/no/such/file"); }),
            ErrorCode::invalid_configuration);
}

TEST(PasswordUsers, AreReadFromAFile) {
  const std::string path = ::testing::TempDir() + "robdef_users_test";
  std::ofstream(path) << "u 5ebe2294ecd0e0f08eab7690d2a6ee69 objectlock\n";
  const auto users = PasswordUsers::from_file(path);
  std::remove(path.c_str());
  EXPECT_TRUE(users->authenticate("u", with_password("secret"), {}).has(lock_privilege));
}

}  // namespace
}  // namespace rr::testing
