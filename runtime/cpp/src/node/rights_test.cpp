// SPDX-License-Identifier: Apache-2.0
#include "rr/rights.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "runtime/cpp/src/node/testing/guarded_client.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

const User user_alice{"alice", {"operator"}};
const User user_guest{"guest"};

bool may(const Rights& rights, const User* user, Right right, std::string_view path,
         std::string_view member) {
  return has_right(rights.of(user, path, member), right);
}

TEST(Rights, TheFirstRuleThatMatchesDecidesAndNoneDenies) {
  const Rights rights(
      "# comments and empty lines mean nothing\n"
      "\n"
      "deny  user:alice path arm member speed access set   # not even she\n"
      "allow role:operator path arm access get,set\n"
      "allow user:* path arm member speed access get\r\n"
      "allow anyone path arm member status access get\n");
  EXPECT_TRUE(may(rights, &user_alice, Right::get, "arm", "speed"));
  EXPECT_FALSE(may(rights, &user_alice, Right::set, "arm", "speed"));
  EXPECT_TRUE(may(rights, &user_alice, Right::set, "arm", "force"));
  EXPECT_FALSE(may(rights, &user_alice, Right::call, "arm", "force"));
  EXPECT_FALSE(may(rights, &user_alice, Right::get, "other", "speed"));
  EXPECT_TRUE(may(rights, &user_guest, Right::get, "arm", "speed"));
  EXPECT_FALSE(may(rights, &user_guest, Right::get, "arm", "force"));
  EXPECT_FALSE(may(rights, nullptr, Right::get, "arm", "speed"));
  EXPECT_TRUE(may(rights, nullptr, Right::get, "arm", "status"));
  EXPECT_EQ(Rights("").of(&user_alice, "arm", "speed"), 0);
  EXPECT_EQ(Rights("allow anyone").of(nullptr, "arm.x[3].y", "speed"), all_rights);
}

TEST(Rights, PathsNameObjectsIndexesAndWhatIsBelow) {
  struct Case {
    const char* pattern;
    const char* path;
    bool holds;
  };
  const std::vector<Case> cases{
      {"arm", "arm", true},
      {"arm", "arm.tool", false},
      {"arm.*", "arm.tool", true},
      {"arm.*", "arm.tool[3]", true},
      {"arm.*", "arm", false},
      {"arm.*", "arm.tool.tip", false},
      {"arm.*[*]", "arm.tool", false},
      {"arm.*[*]", "arm.tool[x]", true},
      {"arm.**", "arm", true},
      {"arm.**", "arm.tool[3].tip", true},
      {"arm.**", "army", false},
      {"arm.tool[3]", "arm.tool[3]", true},
      {"arm.tool[3]", "arm.tool[4]", false},
      {"arm.tool[3]", "arm.tool", false},
      {"arm.tool[*]", "arm.tool[4]", true},
      {"arm.tool[*].tip", "arm.tool[4].tip", true},
      {"arm.tool[*].**", "arm.tool[4].tip.end", true},
      {"arm.tool", "arm.tool[4]", false},
      {"*.tool", "leg.tool", true},
      {"arm.tool[a%20b]", "arm.tool[a%20b]", true},
      {"arm.tool[a_b]", "arm.tool[a%5fb]", true},
      {"arm.tool[%2d3]", "arm.tool[%2D3]", true},
      {"arm,leg.**", "leg.foot", true},
      {"arm,leg.**", "arm.tool", false},
      {"**", "anything.at[all]", true},
      {"**", "not a path", false},
  };
  for (const Case& each : cases) {
    SCOPED_TRACE(std::string(each.pattern) + " and " + each.path);
    const Rights rights("allow anyone path " + std::string(each.pattern));
    EXPECT_EQ(may(rights, nullptr, Right::get, each.path, "x"), each.holds);
  }
}

// `[03]` leads to the same object as `[3]` where indexes are numbers.
TEST(Rights, AnotherSpellingOfANumberGetsRoundNoRule) {
  const Rights denied("deny anyone path arm.tool[3].**\nallow anyone\n");
  const Rights allowed("allow anyone path arm.tool[3]\n");
  for (const char* index : {"3", "03", "0003"}) {
    const std::string path = "arm.tool[" + std::string(index) + "]";
    EXPECT_FALSE(may(denied, nullptr, Right::get, path, "x")) << path;
    EXPECT_EQ(may(allowed, nullptr, Right::get, path, "x"), path == "arm.tool[3]") << path;
  }
  EXPECT_TRUE(may(denied, nullptr, Right::get, "arm.tool[4]", "x"));
  const Rights negative("deny anyone path arm.tool[-3]\nallow anyone\n");
  EXPECT_FALSE(may(negative, nullptr, Right::get, "arm.tool[%2d03]", "x"));
}

TEST(Rights, LetTheWayToWhatIsAllowedBeAsked) {
  const Rights rights(
      "deny  anyone path arm.secret.** access describe\n"
      "allow anyone path arm.tools[*].gripper.** member width access get\n");
  for (const char* path :
       {"arm", "arm.tools[2]", "arm.tools[2].gripper", "arm.tools[2].gripper.finger"}) {
    EXPECT_EQ(rights.of(nullptr, path, ""), static_cast<RightSet>(Right::describe)) << path;
  }
  for (const char* path : {"leg", "arm.tools", "arm.base", "arm.secret", "arm.tools[2].cutter"}) {
    EXPECT_EQ(rights.of(nullptr, path, ""), 0) << path;
  }
}

// What concerns an object is not given by a rule about some of its members.
TEST(Rights, OfMembersDoNotGiveLocks) {
  const Rights rights("allow user:* member speed\n");
  EXPECT_FALSE(may(rights, &user_alice, Right::lock, "arm", ""));
  EXPECT_FALSE(may(rights, &user_alice, Right::lock, "arm", "speed"));
  EXPECT_TRUE(may(rights, &user_alice, Right::set, "arm", "speed"));
}

TEST(Rights, WhatIsWrongIsToldWithLineAndColumn) {
  struct Case {
    const char* text;
    const char* place;
    const char* what;
  };
  const std::vector<Case> cases{
      {"grant anyone", "r:1:1: ", "`allow` or `deny`"},
      {"allow anyone\n  deny", "r:2:3: ", "does not say who"},
      {"allow everybody", "r:1:7: ", "nobody: anyone"},
      {"allow user:", "r:1:12: ", "a name is missing"},
      {"allow role:*", "r:1:12: ", "user:*"},
      {"allow anyone place x", "r:1:14: ", "none of path, member and access"},
      {"allow anyone path", "r:1:14: ", "missing behind"},
      {"allow anyone path a path b", "r:1:21: ", "already"},
      {"allow anyone path a.**.b", "r:1:21: ", "end of a path"},
      {"allow anyone path a..b", "r:1:21: ", "no name of a path"},
      {"allow anyone path a.b[", "r:1:22: ", "not closed"},
      {"allow anyone path a.b[]", "r:1:23: ", "an index is missing"},
      {"allow anyone path a.b[%g0]", "r:1:23: ", "two hexadecimal"},
      {"allow anyone path a.b[x$]", "r:1:24: ", "`%` and two"},
      {"allow anyone path a,,b", "r:1:21: ", "beside a comma"},
      {"allow anyone path a, b", "r:1:21: ", "beside a comma"},
      {"allow anyone member 3d", "r:1:21: ", "no member"},
      {"allow anyone access get,put", "r:1:25: ", "`put` is no access"},
  };
  for (const Case& each : cases) {
    SCOPED_TRACE(each.text);
    const Error error = error_of([&] { const Rights rights(each.text, "r"); });
    EXPECT_EQ(error.code(), ErrorCode::invalid_configuration);
    EXPECT_THAT(error.message(), ::testing::StartsWith(each.place));
    EXPECT_THAT(error.message(), HasSubstr(each.what));
  }
  EXPECT_EQ(code_of([] { Rights::from_file("/no/such/file"); }), ErrorCode::invalid_configuration);
  EXPECT_EQ(code_of([] { Rights::from_file("/"); }), ErrorCode::invalid_configuration);
}

TEST(Rights, AreGivenInCodeToo) {
  const Rights rights({{.who = "role:operator", .path = "arm.**", .access = "get,call"},
                       {.is_allowed = false, .who = "anyone"}});
  EXPECT_TRUE(may(rights, &user_alice, Right::call, "arm.tool", "open"));
  EXPECT_FALSE(may(rights, &user_guest, Right::call, "arm.tool", "open"));
  const Error error = error_of([] {
    const Rights wrong(std::vector<Rights::Rule>{{}, {.path = "a.**.b"}});
  });
  EXPECT_THAT(error.message(), HasSubstr("rule 2: "));
}

// Each word alone allows what it says and nothing else.
TEST(RightsOfAService, EachWordAllowsItsOwnEntries) {
  using Ask = std::function<std::uint16_t(GuardedClient&)>;
  const auto ask = [](EntryType type, const std::string& member,
                      const RawClient::Elements& elements = nullptr) {
    return [=](GuardedClient& client) { return client.ask(type, "guarded", member, elements); };
  };
  const auto part = [](bool has_data) {
    return [has_data](Writer& writer) {
      const std::uint64_t numbers[] = {0, 1};
      const Array<double> data{1.0};
      if (has_data) type_of<Array<double>>.write(writer, "data", &data);
      type_of<std::uint64_t>.write(writer, "count", &numbers[1]);
      type_of<std::uint64_t>.write(writer, "memorypos", &numbers[0]);
      return has_data ? 3U : 2U;
    };
  };
  struct Case {
    const char* member;
    std::vector<std::string> words;
    Ask ask;
  };
  const std::vector<Case> cases{
      {"value", {"get"}, ask(EntryType::property_get_req, "value")},
      {"value", {"set"}, ask(EntryType::property_set_req, "value", element("value", 1.0))},
      {"run", {"call"}, ask(EntryType::function_call_req, "run", element<std::string>("what", ""))},
      {"level", {"connect"}, ask(EntryType::wire_connect_req, "level")},
      {"samples",
       {"connect"},
       ask(EntryType::pipe_connect_req, "samples", element<std::int32_t>("index", -1))},
      {"level", {"peek"}, ask(EntryType::wire_peek_in_value_req, "level")},
      {"level", {"peek"}, ask(EntryType::wire_peek_out_value_req, "level")},
      {"level",
       {"poke"},
       ask(EntryType::wire_poke_out_value_req, "level", GuardedClient::wire_value(5))},
      {"store", {"read"}, ask(EntryType::memory_read, "store", part(false))},
      {"store", {"write"}, ask(EntryType::memory_write, "store", part(true))},
      {"store",
       {"read", "write"},
       ask(EntryType::memory_get_param, "store", element<std::string>("parameter", "Length"))},
      {"", {"lock"}, [](GuardedClient& client) { return client.operation("RequestObjectLock"); }},
      {"", {"describe"}, ask(EntryType::object_type_name, "")},
  };
  const std::array<std::string, 13> words{"get",      "set",  "call",    "connect", "send",
                                          "peek",     "poke", "read",    "write",   "event",
                                          "callback", "lock", "describe"};
  for (const std::string& word : words) {
    for (const Case& each : cases) {
      // A session for each: that of a lock would be in the way of the rest.
      GuardedService service(
          GuardedService::with_rights("deny anyone access describe\nallow user:* access " + word));
      if (word == "describe") {
        service.service->set_rights(std::make_shared<Rights>("allow user:* access describe"));
      }
      GuardedClient client(service, "alice");
      SCOPED_TRACE(word + " and " + each.member);
      const bool is_allowed =
          std::find(each.words.begin(), each.words.end(), word) != each.words.end();
      EXPECT_EQ(each.ask(client), is_allowed ? 0 : refused);
    }
  }
}

TEST(RightsOfAService, ARefusalNamesTheMember) {
  GuardedService service(GuardedService::with_rights("allow user:* member run\n"));
  GuardedClient client(service, "alice");
  const auto text = [&](EntryType type, const std::string& member) {
    return client.answer(type, "guarded", member).value_of<std::string>("errorstring");
  };
  EXPECT_EQ(text(EntryType::property_get_req, "value"),
            "User `alice` may not get `value` of `guarded`");
  EXPECT_EQ(text(EntryType::wire_connect_req, "level"),
            "User `alice` may not connect `level` of `guarded`");
  // A member that is not there is refused in the same words.
  EXPECT_EQ(text(EntryType::property_get_req, "nothing"),
            "User `alice` may not get `nothing` of `guarded`");
  EXPECT_EQ(client.ask(EntryType::property_get_req, "guarded.child[zz].own", "value"), refused);
  EXPECT_EQ(service.object->children, 0);  // nor is the way there asked of the program
}

TEST(RightsOfAService, HoldForPacketsAndEventsAndCallbacks) {
  GuardedService service(
      GuardedService::with_rights("allow user:alice\n"
                                  "allow user:guest member level,samples access connect\n"));
  GuardedClient guest(service, "guest");
  EXPECT_EQ(guest.connect_wire(), 0);
  const std::int32_t index = guest.connect_pipe();
  guest.settle();
  guest.raw().send(EntryType::wire_packet, "guarded", "level", GuardedClient::wire_value(1));
  EXPECT_EQ(guest.raw().receive().value().error, refused);
  guest.raw().send(EntryType::pipe_packet, "guarded", "samples",
                   GuardedClient::pipe_packet(index, 1));
  EXPECT_EQ(guest.raw().receive().value().error, refused);
  EXPECT_EQ(service.object->values + service.object->packets, 0);
  service.object->notice(1);
  EXPECT_EQ(code_of([&] { (void)service.object->ask(service.service->clients().at(0).endpoint); }),
            ErrorCode::authentication_error);
  EXPECT_THAT(guest.settle(), IsEmpty());
  GuardedClient alice(service, "alice");
  service.object->notice(2);
  EXPECT_THAT(alice.settle(), ::testing::ElementsAre(EntryType::event_req));
}

TEST(RightsOfAService, HoldForWhoeverIsNotLoggedIn) {
  auto options = GuardedService::with_rights(
      "allow anyone path guarded member value access get\n"
      "allow user:* path guarded.**\n");
  options.require_user = false;
  GuardedService service(std::move(options));
  GuardedClient client(service, "");
  EXPECT_EQ(client.ask(EntryType::property_get_req, "guarded", "value"), 0);
  EXPECT_EQ(client.ask(EntryType::property_get_req, "guarded.child[a]", "value"), refused);
  // Nor before there is a session.
  GuardedClient stranger(service);
  EXPECT_EQ(stranger.ask(EntryType::object_type_name, "guarded", ""), 0);
  EXPECT_EQ(stranger.ask(EntryType::object_type_name, "guarded.child[a]", ""),
            code(ErrorCode::object_not_found));
  EXPECT_EQ(service.object->children, 0);
  EXPECT_EQ(client.log_in("guest"), 0);
  EXPECT_EQ(client.ask(EntryType::property_get_req, "guarded.child[a]", "value"), 0);
}

TEST(RightsOfAService, AGeneratorBelongsToTheMemberThatGaveIt) {
  GuardedService service;
  GuardedClient alice(service, "alice");
  GuardedClient bob(service, "bob");
  const std::int32_t index = bob.open_generator();
  EXPECT_EQ(alice.operation("RequestObjectLock"), 0);
  EXPECT_EQ(bob.step(index), code(ErrorCode::object_locked_error));
  // `free` passes locks, the generator of `count` does not.
  EXPECT_EQ(bob.step(index, "guarded", "free"), code(ErrorCode::object_locked_error));
}

class RightsFileTest : public ::testing::Test {
 protected:
  ~RightsFileTest() override { std::remove(path_.c_str()); }
  void write(const std::string& text) const {
    const std::string next = path_ + ".next";
    std::ofstream(next) << text;
    std::rename(next.c_str(), path_.c_str());
  }
  const std::string path_ = ::testing::TempDir() + "robdef_rights_" + std::to_string(::getpid());
};

TEST_F(RightsFileTest, IsReadAgainWhenItHasChanged) {
  std::mutex mutex;
  std::string log;
  write("allow user:*\n");
  GuardedService service({.users = std::make_shared<KnownUsers>(), .rights_file = path_},
                         {.log = [&](LogLevel, std::string_view text) {
                           const std::lock_guard lock(mutex);
                           log += std::string(text) + "\n";
                         }});
  GuardedClient client(service, "alice");
  EXPECT_EQ(client.connect_wire(), 0);
  EXPECT_EQ(service.object->level().connection_count(), 1U);
  write("allow user:* member value access get\n");
  EXPECT_TRUE(eventually([&] { return service.object->level().connection_count() == 0; }));
  EXPECT_EQ(client.ask(EntryType::property_get_req, "guarded", "value"), 0);
  EXPECT_EQ(client.connect_wire(), refused);
  // What cannot be read changes nothing.
  write("allow user:* member value access get\nallow nobody\n");
  EXPECT_TRUE(eventually([&] {
    const std::lock_guard lock(mutex);
    return log.find(path_ + ":2:7: ") != std::string::npos;
  }));
  EXPECT_EQ(client.ask(EntryType::property_get_req, "guarded", "value"), 0);
  EXPECT_EQ(client.connect_wire(), refused);
}

TEST_F(RightsFileTest, ThatIsWrongMakesNoService) {
  write("allow\n");
  const Error error = error_of([&] {
    const GuardedService service({.users = std::make_shared<KnownUsers>(), .rights_file = path_});
  });
  EXPECT_EQ(error.code(), ErrorCode::invalid_configuration);
  EXPECT_THAT(error.message(), ::testing::StartsWith(path_ + ":1:1: "));
}

}  // namespace
}  // namespace rr::testing
