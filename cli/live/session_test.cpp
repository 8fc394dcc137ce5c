// SPDX-License-Identifier: Apache-2.0
// watch and connect, as a user runs them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "cli/live/line_words.hpp"
#include "cli/live/object_path.hpp"
#include "cli/live/testing/bench_service.hpp"
#include "cli/live/testing/terminal.hpp"
#include "compiler/driver/program.hpp"
#include "rr/node.hpp"
#include "rr/users.hpp"
#include "runtime/cpp/src/node/testing/server.hpp"

namespace robdef::testing {
namespace {

using rr::testing::eventually;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;

class Sessions : public ::testing::Test {
 protected:
  Ended prompt(const std::string& lines) {
    return run_robdef(folder_, {"connect", server_.url()}, "", lines);
  }
  bool has_wire() const { return bench_->level().connection_count() == 1; }

  const std::shared_ptr<Bench> bench_ = std::make_shared<Bench>();
  rr::testing::Server server_{"bench", bench_};
  TemporaryFolder folder_;
};

TEST_F(Sessions, AServiceThatIsNotThereIsToldBesideThoseThatAre) {
  const auto refusal = [&](const std::string& name) {
    std::string url = server_.url();
    url.replace(url.rfind("bench"), 5, name);
    return run_robdef(folder_, {"get", url, "level"}).err;
  };
  EXPECT_THAT(refusal("bnech"), HasSubstr("Service not found: no `bnech`; did you mean `bench`?"));
  EXPECT_THAT(refusal("lathe"),
              HasSubstr("Service not found: no `lathe`; the node offers `bench`"));
}

TEST_F(Sessions, WiresPipesAndEventsAreWatched) {
  bench_->level().set_in(1.5);
  Running watching(folder_, {"watch", server_.url(), "level", "points", "ticked", "--count", "3"});
  ASSERT_TRUE(eventually([&] { return watching.out().find('\n') != std::string::npos; }));
  ASSERT_TRUE(eventually([&] { return bench_->points().endpoint_count() == 1; }));
  bench_->points().send({.x = 1, .y = -2});
  ASSERT_TRUE(eventually([&] {
    bench_->ticked(7, "a \"b\"");
    return watching.out().find("ticked") != std::string::npos;
  }));
  EXPECT_EQ(watching.end(0), 0);
  EXPECT_THAT(watching.out(),
              MatchesRegex(
                  "\\{\"member\":\"level\",\"time\":\"20..-..-..T..:..:..\\..........Z\",\"value\":"
                  "1\\.5\\}\n"
                  "\\{\"member\":\"points\",\"value\":\\{\"x\":1,\"y\":-2\\}\\}\n"
                  "\\{\"member\":\"ticked\",\"value\":\\{\"count\":7,\"text\":\"a "
                  "\\\\\"b\\\\\"\"\\}\\}\n"));
  EXPECT_TRUE(eventually([&] { return bench_->level().connection_count() == 0; }));
}

TEST_F(Sessions, AWatchEndsInTimeOrWhenInterrupted) {
  const Ended ended = run_robdef(folder_, {"watch", server_.url(), "ticked", "--for", "0.2"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.out + ended.err, "");
  Running watching(folder_, {"watch", server_.url(), "level"});
  ASSERT_TRUE(eventually([&] { return has_wire(); }));
  EXPECT_EQ(watching.end(SIGTERM), 0);
}

TEST_F(Sessions, AWatchSaysThatTheServiceIsLostAndComesBack) {
  bench_->level().set_in(1);
  Running watching(folder_, {"watch", server_.url(), "level", "--count", "2"});
  ASSERT_TRUE(eventually([&] { return watching.out().find('\n') != std::string::npos; }));
  server_.stop();
  ASSERT_TRUE(
      eventually([&] { return watching.err().find("connection lost") != std::string::npos; }));
  server_.start();
  bench_->level().set_in(2);
  EXPECT_EQ(watching.end(0), 0);
  EXPECT_THAT(watching.err(), HasSubstr("robdef: connected again\n"));
  EXPECT_THAT(watching.out(), HasSubstr("\"value\":2}\n"));
}

TEST_F(Sessions, WhatCannotBeWatchedIsTold) {
  const auto err = [&](const std::string& member) {
    const Ended ended = run_robdef(folder_, {"watch", server_.url(), member});
    EXPECT_EQ(ended.status, 1);
    return ended.err;
  };
  EXPECT_THAT(err("gain"), HasSubstr("member gain: expected wire, pipe or event, got property"));
  EXPECT_THAT(err("nothing"), HasSubstr("has no member `nothing`"));
  server_.stop();
  EXPECT_THAT(err("level"), HasSubstr("ConnectionError"));
}

TEST_F(Sessions, ThePromptTakesCommandsFromAPipe) {
  const Ended ended = prompt(
      "# a comment\n"
      "set pose {\"x\": 1, \"steps\": 2, \"notes\": [\"a b\"]}\n"
      "get pose gain\n"
      "cd lamps[0]\n"
      "set brightness -0.5\n"
      "get brightness\n"
      "ls\n"
      "cd ..\n"
      "call running_sum 1 2 3\n"
      "get buffer --at 3\n"
      "watch ticked --for 0.05\n"
      "describe lamp.brightness\n"
      "ls other\n"
      "help\n"
      "quit\n"
      "get never\n");
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  EXPECT_EQ(ended.out.substr(0, ended.out.find("get MEMBER")),
            "{\"x\":1,\"steps\":2,\"notes\":[\"a b\"]}\n0\n-0.5\nproperty double brightness\n"
            "event switched(bool on)\n3\n6\n[4]\nproperty double brightness\n"
            "    How bright it is.\nproperty double brightness\nevent switched(bool on)\n");
  EXPECT_THAT(ended.out, HasSubstr("unlock"));
}

TEST_F(Sessions, AFailedCommandDoesNotEndThePrompt) {
  const Ended ended = prompt("get nothing\ngte gain\nset gain\ncd lamps[9]\nget fixed");
  EXPECT_EQ(ended.status, 1);
  EXPECT_EQ(ended.out, "42.125\n");
  EXPECT_THAT(ended.err,
              AllOf(HasSubstr("has no member `nothing`"), HasSubstr("did you mean `get`?"),
                    HasSubstr("give a member and a value"), HasSubstr("two lamps")));
}

TEST(Locks, AreMadeAtThePrompt) {
  const auto users = std::make_shared<rr::PasswordUsers>(
      "alice " + rr::PasswordUsers::hash("wonder 1") + " objectlock\n");
  rr::testing::Server server("bench", std::make_shared<Bench>(), {}, {.users = users});
  const TemporaryFolder folder;
  folder.write("password", "wonder 1\n");
  const Ended ended =
      run_robdef(folder, {"connect", server.url(), "--user=alice", "--password-file=password"}, "",
                 "lock client\nset gain 2\nlock\nunlock\nlock user\nunlock\nlock all\n");
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.err,
              AllOf(HasSubstr("ObjectLocked"), HasSubstr("`user` or for this `client`")));
  EXPECT_THAT(run_robdef(folder, {"connect", server.url()}, "", "lock\n").err,
              HasSubstr("AuthenticationError"));
}

TEST_F(Sessions, ATerminalHasAPromptHistoryAndCompletion) {
  Terminal terminal({"connect", server_.url()});
  ASSERT_TRUE(terminal.shows("bench> ")) << terminal.screen();
  terminal.type("get fi\t\n");
  ASSERT_TRUE(terminal.shows("fixed")) << terminal.screen();
  ASSERT_TRUE(terminal.shows("42.125")) << terminal.screen();
  ASSERT_TRUE(terminal.shows("bench> ")) << terminal.screen();
  terminal.type("get lamps[0].b\t\n");
  ASSERT_TRUE(terminal.shows("brightness")) << terminal.screen();
  ASSERT_TRUE(terminal.shows("bench> ")) << terminal.screen();
  terminal.type("get by\t");
  ASSERT_TRUE(terminal.shows("by_name")) << terminal.screen();
  ASSERT_TRUE(terminal.shows("by_number")) << terminal.screen();
  ASSERT_TRUE(terminal.shows("byte")) << terminal.screen();
  terminal.type("te\n");
  ASSERT_TRUE(terminal.shows("bench> ")) << terminal.screen();
  terminal.type("cd lamp\n");
  ASSERT_TRUE(terminal.shows("bench.lamp> ")) << terminal.screen();
  terminal.type("cd\n");
  terminal.type("watch level\n");
  ASSERT_TRUE(eventually([&] { return has_wire(); }));
  terminal.type("\x03");  // ends the watch and not the program
  EXPECT_TRUE(eventually([&] { return bench_->level().connection_count() == 0; }));
  terminal.type("call add 1 2\n");
  EXPECT_TRUE(terminal.shows("3\r\n")) << terminal.screen();
  terminal.type("quit\n");
  EXPECT_EQ(terminal.end(), 0);
}

TEST(Passwords, AreAskedForAtTheTerminal) {
  const auto users =
      std::make_shared<rr::PasswordUsers>("alice " + rr::PasswordUsers::hash("wonder 1") + " _\n");
  rr::testing::Server server("bench", std::make_shared<Bench>(), {},
                             {.users = users, .require_user = true});
  Terminal terminal({"get", server.url(), "fixed", "--user", "alice"});
  ASSERT_TRUE(terminal.shows("password of alice: ")) << terminal.screen();
  terminal.type("wonder 1\n");
  EXPECT_TRUE(terminal.shows("42.125")) << terminal.screen();
  EXPECT_EQ(terminal.end(), 0);
  EXPECT_THAT(terminal.screen(), Not(HasSubstr("wonder")));
}

TEST_F(Sessions, APromptConnectsAgainWhenTheServiceIsBack) {
  Terminal terminal({"connect", server_.url()});
  ASSERT_TRUE(terminal.shows("bench> ")) << terminal.screen();
  terminal.type("watch level\n");
  ASSERT_TRUE(eventually([&] { return has_wire(); }));
  server_.stop();
  ASSERT_TRUE(terminal.shows("robdef: ")) << terminal.screen();
  ASSERT_TRUE(terminal.shows("bench> ")) << terminal.screen();
  server_.start();
  terminal.type("get fixed\n");
  EXPECT_TRUE(terminal.shows("connecting again")) << terminal.screen();
  EXPECT_TRUE(terminal.shows("42.125")) << terminal.screen();
  // What is no line yet may get lost while the terminal is not read.
  ASSERT_TRUE(terminal.shows("bench> ")) << terminal.screen();
  terminal.type("\x04");  // the end of the input
  EXPECT_EQ(terminal.end(), 0);
}

TEST_F(Sessions, AWatchEndsWhenNothingCanBePrinted) {
  bench_->level().set_in(1);
  const std::string command = "'" ROBDEF_PROGRAM "' watch '" + server_.url() +
                              "' level >/dev/full 2>'" + (folder_ / "err") + "'";
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 1);
  EXPECT_THAT(read_text(folder_ / "err"), HasSubstr("standard output cannot be written"));
}

TEST(Words, AreValuesAsJsonToo) {
  EXPECT_THAT(
      live::split_line("call  move [1, 2] \"a \\\" ]text\" {\"k\": [1, {}]} lamps[left one].x")
          .words,
      ElementsAre("call", "move", "[1, 2]", "\"a \\\" ]text\"", "{\"k\": [1, {}]}",
                  "lamps[left one].x"));
  EXPECT_TRUE(live::split_line("get ga").is_last_open);
  EXPECT_FALSE(live::split_line("get ").is_last_open);
}

TEST(Paths, AreReadAndWritten) {
  const live::ObjectPath path = live::parse_object_path("a[0].b[x%5d. y].c");
  EXPECT_THAT(path, ElementsAre(live::PathStep{"a", "0"}, live::PathStep{"b", "x]. y"},
                                live::PathStep{"c", std::nullopt}));
  EXPECT_EQ(live::parse_object_path(live::text_of(path)), path);
  for (const char* const wrong : {".", "a.", "a[0", "a[0]b", "[0]", "a[%4]", "a b"}) {
    EXPECT_THROW((void)live::parse_object_path(wrong), rr::Error) << wrong;
  }
}

}  // namespace
}  // namespace robdef::testing
