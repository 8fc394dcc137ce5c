// SPDX-License-Identifier: Apache-2.0
// robdef breaking, as a user runs it: where versions come from, and how it ends.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <rr/dynamic_service.hpp>
#include <rr/node.hpp>
#include <rr/tap.hpp>

#include "compiler/driver/program.hpp"

namespace robdef {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr std::string_view types_text =
    "service example.types\nstdver 0.10\nstruct Pose\n    field double x\nend\n";
constexpr std::string_view arm_text =
    "service example.arm\nstdver 0.10\nimport example.types\nusing example.types.Pose\n\n"
    "object Arm\n    property Pose pose\n    property double speed\nend\n";
// Without `speed`.
constexpr std::string_view new_arm_text =
    "service example.arm\nstdver 0.10\nimport example.types\nusing example.types.Pose\n\n"
    "object Arm\n    property Pose pose\nend\n";

class BreakingCommand : public testing::Test {
 protected:
  Ended run(std::vector<std::string> arguments, const std::string& input = "") {
    arguments.insert(arguments.begin(), "breaking");
    return run_robdef(folder_, arguments, "", input);
  }
  void write_both() {
    for (const char* const side : {"old", "new"}) {
      folder_.write(std::string(side) + "/example.types.robdef", types_text);
    }
    folder_.write("old/example.arm.robdef", arm_text);
    folder_.write("new/example.arm.robdef", new_arm_text);
  }
  // In a repository of the folder; what it prints is of no interest.
  void git(const std::string& words) {
    const std::string command =
        "cd '" + folder_.path().string() +
        "' && git -c user.name=a -c user.email=a@example.com -c commit.gpgsign=false "
        "-c init.defaultBranch=main " +
        words + " >/dev/null 2>&1";
    ASSERT_EQ(std::system(command.c_str()), 0) << words;
  }
  // `definitions` in HEAD~1 is the old version, in the working tree the new one.
  void make_repository() {
    git("init");
    folder_.write("definitions/example.arm.robdef", arm_text);
    folder_.write("definitions/example.types.robdef", types_text);
    git("add .");
    git("commit -m first");
    folder_.write("definitions/example.arm.robdef", new_arm_text);
    git("commit -a -m second");
  }

  TemporaryFolder folder_;
};

TEST_F(BreakingCommand, ComparesFilesAndFolders) {
  write_both();
  const Ended folders = run({"old", "new"});
  EXPECT_EQ(folders.status, 1) << folders.err;
  EXPECT_THAT(folders.out, AllOf(StartsWith("error[R0703]: property `Arm.speed` is gone\n"),
                                 HasSubstr(" --> new/example.arm.robdef:6:8\n"),
                                 HasSubstr(" ::: old/example.arm.robdef:8:21\n"),
                                 HasSubstr("\n1 breaking change\n")));
  EXPECT_EQ(folders.err, "");
  EXPECT_EQ(run({"old/example.arm.robdef", "new/example.arm.robdef"}).out, folders.out)
      << "imports are found beside the file";
  const Ended same = run({"old", "old"});
  EXPECT_EQ(same.status, 0);
  EXPECT_EQ(same.out + same.err, "");
  EXPECT_EQ(run({"new", "old"}).status, 0) << "a new member breaks nobody";
}

TEST_F(BreakingCommand, FindsImportsAsCheckDoes) {
  folder_.write("old.robdef", arm_text);
  folder_.write("new.robdef", new_arm_text);
  folder_.write("shared/example.types.robdef", types_text);
  const Ended without = run({"old.robdef", "new.robdef"});
  EXPECT_EQ(without.status, 2);
  EXPECT_THAT(without.err,
              AllOf(HasSubstr("example.types"), HasSubstr("robdef: old.robdef: has errors")));
  EXPECT_EQ(without.out, "");
  EXPECT_EQ(run({"-I", "shared", "old.robdef", "new.robdef"}).status, 1);
  EXPECT_EQ(run({"-I", "shared", "old.robdef", "-"}, std::string(new_arm_text)).status, 1);
}

TEST_F(BreakingCommand, TakesCategoriesAndCodes) {
  folder_.write("old.robdef", "service a\nstdver 0.10\nconstant int32 A 1\nenum E\nb = 0\nend\n");
  folder_.write("new.robdef", "service a\nstdver 0.10\nconstant int32 A 2\nenum E\nc = 0\nend\n");
  EXPECT_THAT(run({"old.robdef", "new.robdef"}).out, HasSubstr("2 breaking changes\n"));
  const Ended source = run({"--category", "source,wire", "old.robdef", "new.robdef"});
  EXPECT_THAT(source.out, AllOf(HasSubstr("R0742"), Not(HasSubstr("R0773"))));
  EXPECT_EQ(run({"--category=wire", "old.robdef", "new.robdef"}).status, 0);
  const Ended allowed = run({"--allow=r0742", "--allow", "R0773", "old.robdef", "new.robdef"});
  EXPECT_EQ(allowed.status, 0) << allowed.out;
}

TEST_F(BreakingCommand, PrintsJsonAndAnnotations) {
  write_both();
  const Ended json = run({"--format=json", "old", "new"});
  EXPECT_EQ(json.status, 1);
  EXPECT_THAT(json.out, AllOf(StartsWith("{\n  \"breaking_version\": 1,\n  \"old\": \"old\","),
                              HasSubstr("\"code\": \"R0703\"")));
  EXPECT_THAT(run({"--format=json", "old", "old"}).out, HasSubstr("\"count\": 0"));
  EXPECT_THAT(run({"--format", "github", "old", "new"}).out,
              StartsWith("::error file=new/example.arm.robdef,line=6,endLine=6,col=8,endColumn=11,"
                         "title=R0703 "));
}

TEST_F(BreakingCommand, WrongUseIsStatusTwo) {
  write_both();
  EXPECT_EQ(run({"old"}).status, 2);
  EXPECT_EQ(run({"old", "new", "more"}).status, 2);
  EXPECT_THAT(run({"--category=wires", "old", "new"}).err, HasSubstr("unknown category `wires`"));
  EXPECT_THAT(run({"--allow=R0203", "old", "new"}).err,
              HasSubstr("`R0203` is no code of a breaking change"));
  EXPECT_THAT(run({"--format=line", "old", "new"}).err,
              HasSubstr("known: `text`, `json`, `github`"));
  EXPECT_EQ(run({"--user", "me", "old", "new"}).status, 2);
  const Ended missing = run({"old", "nowhere.robdef"});
  EXPECT_EQ(missing.status, 2);
  EXPECT_THAT(missing.err, HasSubstr("there is no file `nowhere.robdef`"));
  std::filesystem::create_directory(folder_.path() / "empty");
  const Ended empty = run({"empty", "new"});
  EXPECT_EQ(empty.status, 2);
  EXPECT_EQ(empty.err, "robdef: empty: there is no .robdef file in this folder\n");
}

TEST_F(BreakingCommand, ADefinitionWithErrorsIsNotCompared) {
  folder_.write("good.robdef", "service a\nstdver 0.10\n");
  folder_.write("bad.robdef", "service a\nstdver 0.10\nobject O\nproperty Angle p\nend\n");
  const Ended ended = run({"good.robdef", "bad.robdef"});
  EXPECT_EQ(ended.status, 2);
  EXPECT_EQ(ended.out, "");
  EXPECT_THAT(ended.err, AllOf(HasSubstr("error[R0203]"), HasSubstr("--> bad.robdef:4:10")));
}

TEST_F(BreakingCommand, ReadsRevisionsOfGit) {
  make_repository();
  const Ended folder = run({"HEAD~1:definitions", "definitions"});
  EXPECT_EQ(folder.status, 1) << folder.err;
  EXPECT_THAT(folder.out, AllOf(HasSubstr("R0703"),
                                HasSubstr(" ::: HEAD~1:definitions/example.arm.robdef:8:21\n")));
  const Ended file =
      run({"HEAD~1:definitions/example.arm.robdef", "HEAD:definitions/example.arm.robdef"});
  EXPECT_EQ(file.status, 1) << file.err;
  EXPECT_THAT(file.out, HasSubstr(" --> HEAD:definitions/example.arm.robdef:6:8\n"));
  EXPECT_EQ(run({"HEAD~1:", "HEAD~1:./definitions/"}).status, 0) << "the whole tree, and a folder";
  EXPECT_EQ(run({"HEAD:./definitions/example.arm.robdef", "definitions"}).status, 0);
  EXPECT_EQ(run({"HEAD:definitions", "definitions"}).status, 0);
  EXPECT_THAT(run({"--format=github", "definitions", "HEAD:definitions"}).out, "");
}

TEST_F(BreakingCommand, SaysWhatGitCannotRead) {
  const Ended outside = run({"HEAD:definitions", "HEAD:definitions"});
  EXPECT_EQ(outside.status, 2);
  EXPECT_THAT(outside.err, StartsWith("robdef: HEAD:definitions: git: not a git repository"));
  make_repository();
  EXPECT_THAT(run({"v9:definitions", "definitions"}).err,
              StartsWith("robdef: v9:definitions: git: "));
  EXPECT_THAT(run({"HEAD:nowhere", "definitions"}).err, HasSubstr("nowhere"));
  EXPECT_THAT(run({"--", "--output=x:definitions", "definitions"}).err,
              HasSubstr("no revision begins with `-`"));
  EXPECT_THAT(run({":definitions", "definitions"}).err, HasSubstr("no revision before the `:`"));
  folder_.write("text", "no definition");
  git("add .");
  git("commit -m third");
  const Ended none = run({"HEAD:text", "definitions"});
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("HEAD:text"));
}

TEST_F(BreakingCommand, NamesInARevisionAreNoCommands) {
  make_repository();
  folder_.write("odd/$(touch hit);`touch hit`.robdef", types_text);
  git("add .");
  git("commit -m odd");
  EXPECT_EQ(run({"HEAD:odd", "odd"}).status, 0);
  EXPECT_EQ(run({"HEAD:odd/$(touch hit);`touch hit`.robdef", "odd"}).status, 0);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "hit"));
  folder_.write("odd/a\n::error::b.robdef", types_text);
  git("add .");
  git("commit -m line");
  const Ended line = run({"HEAD:odd", "odd"});
  EXPECT_EQ(line.status, 2);
  EXPECT_THAT(line.err, HasSubstr("the name `a ::error::b.robdef` holds a control character"));
}

TEST_F(BreakingCommand, AFileThatIsThereComesBeforeARevision) {
  folder_.write("HEAD:a.robdef", "service a\nstdver 0.10\n");
  EXPECT_EQ(run({"HEAD:a.robdef", "HEAD:a.robdef"}).status, 0);
}

// A service that offers the old version, and what its client records.
class BreakingLive : public BreakingCommand {
 protected:
  BreakingLive() {
    arm_.store("speed", 1.0);
    service_ = rr::dynamic::register_service(server_, "arm", arm_);
    const std::uint16_t port = server_.listen_tcp(0, "127.0.0.1");
    url_ = "rr+tcp://127.0.0.1:" + std::to_string(port) + "/?service=arm";
  }
  std::string record() {
    std::string path = folder_ / "tape";
    rr::Node node({.tap = std::make_shared<rr::Recorder>(path)});
    const rr::dynamic::Client client = rr::dynamic::connect(node, url_);
    EXPECT_EQ(client->get("speed").as<double>(), 1.0);
    return path;
  }

  const rr::dynamic::ServedObject arm_{
      rr::dynamic::Definitions({std::string(arm_text), std::string(types_text)}),
      "example.arm.Arm"};
  rr::Node server_;
  rr::Service service_;
  std::string url_;
};

TEST_F(BreakingLive, ReadsARunningService) {
  write_both();
  const Ended ended = run({url_, "new"});
  EXPECT_EQ(ended.status, 1) << ended.err;
  EXPECT_THAT(ended.out, AllOf(HasSubstr("property `Arm.speed` is gone"),
                               HasSubstr(" ::: " + url_ + ", example.arm:8:21\n")));
  EXPECT_EQ(run({url_, "old"}).status, 0);
  EXPECT_EQ(run({"old", url_}).status, 0);
  EXPECT_THAT(run({"--format=github", "old", url_}).out, "");
}

TEST_F(BreakingLive, WhatAServiceDoesNotSendMayExist) {
  write_both();
  folder_.write("old/example.more.robdef", "service example.more\nstdver 0.10\n");
  EXPECT_EQ(run({"old", url_}).status, 0);
  EXPECT_THAT(run({"old", "new"}).out, HasSubstr("service `example.more` is gone"));
}

TEST_F(BreakingLive, ReadsARecording) {
  write_both();
  const std::string tape = record();
  const Ended ended = run({tape, "new"});
  EXPECT_EQ(ended.status, 1) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("property `Arm.speed` is gone"));
  EXPECT_EQ(run({"tape", "old"}).status, 0) << "without what every node offers";
  EXPECT_EQ(run({"tape", url_}).status, 0);
  const std::string bytes = read_text(tape);
  folder_.write("cut", bytes.substr(0, bytes.size() - 3));
  const Ended cut = run({"cut", "old"});
  EXPECT_EQ(cut.status, 0) << cut.out;
  EXPECT_THAT(cut.err, HasSubstr("robdef: cut: cut off or damaged at byte "));
  folder_.write("empty", bytes.substr(0, 32));
  EXPECT_THAT(run({"empty", "old"}).err, HasSubstr("robdef: empty: holds no definitions"));
  folder_.write("short", bytes.substr(0, 20));
  EXPECT_EQ(run({"short", "old"}).status, 2);
}

TEST_F(BreakingLive, AServiceThatIsNotThereIsAReadingError) {
  write_both();
  service_->close();
  const Ended ended = run({"old", url_});
  EXPECT_EQ(ended.status, 2);
  EXPECT_THAT(ended.err, StartsWith("robdef: " + url_ + ": "));
}

}  // namespace
}  // namespace robdef
