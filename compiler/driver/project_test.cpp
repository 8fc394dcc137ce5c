// SPDX-License-Identifier: Apache-2.0
// Runs the built program in folders with a project file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "compiler/driver/program.hpp"

namespace robdef {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class ProjectCommand : public testing::Test {
 protected:
  ProjectCommand() {
    folder_.write(
        "shared/example.base.robdef",
        "service example.base\nstdver 0.10\n\nstruct Angles\n    field double pan\nend\n");
    folder_.write("definitions/example.mount.robdef",
                  "service example.mount\nstdver 0.10\nimport example.base\n\nobject Mount\n"
                  "    property example.base.Angles angles\n    property double nectarAnchor\n"
                  "    property double nectar_anchor\n    property double x [shiny]\nend\n");
  }

  // The project file, with inputs and imports.
  void write_project(const std::string& rest) const {
    folder_.write("robdef.toml",
                  "inputs = [\"definitions/*.robdef\"]\nimport-path = [\"shared\"]\n" + rest);
  }
  Ended run(const std::vector<std::string>& arguments) { return run_robdef(folder_, arguments); }
  [[nodiscard]] bool has(const std::string& file) const {
    return std::filesystem::exists(folder_.path() / file);
  }

  TemporaryFolder folder_;
};

TEST_F(ProjectCommand, GenerateWritesAllOutputsInOneRun) {
  write_project(
      "[cpp]\noutput = \"out/cpp\"\n[typescript]\noutput = \"out/ts\"\n"
      "[csharp]\nrename = {}\n");
  const Ended failed = run({"generate"});
  EXPECT_EQ(failed.status, 1) << "two names are one in TypeScript";
  EXPECT_THAT(failed.err,
              AllOf(HasSubstr("error[R0901]: the TypeScript name"), Not(HasSubstr("C#"))));
  EXPECT_FALSE(has("out")) << "all or nothing";

  write_project("[cpp]\noutput = \"out/cpp\"\n[matlab]\noutput = \"out/matlab\"\n");
  const Ended ended = run({"generate"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_TRUE(has("out/cpp/example/mount.hpp"));
  EXPECT_TRUE(has("out/matlab/+example_/+mount/Mount.m"));
}

TEST_F(ProjectCommand, TheNearestFileAboveIsFoundAndItsPathsBeginThere) {
  write_project("[cpp]\noutput = \"out\"\n");
  folder_.write("deep/er/x", "");
  const std::string command = "cd '" + (folder_ / "deep/er") +
                              "' && '" ROBDEF_PROGRAM "' generate >'" + (folder_ / "log") +
                              "' 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0);
  EXPECT_TRUE(has("out/example/mount.hpp"));
  EXPECT_THAT(read_text(folder_ / "log"),
              HasSubstr("--> ../../definitions/example.mount.robdef:9:24"));
}

TEST_F(ProjectCommand, CheckReadsTheInputsOfTheFile) {
  write_project("");
  const Ended ended = run({"check", "--format=line"});
  EXPECT_EQ(ended.status, 0);
  EXPECT_THAT(ended.err, StartsWith("definitions/example.mount.robdef(9,24): warning: R0610"));
  EXPECT_THAT(run({"describe"}).out, HasSubstr("example.mount"));
  EXPECT_THAT(run({"model"}).out, HasSubstr("example.mount"));
  EXPECT_THAT(run({"view", "--lang", "cpp"}).out, HasSubstr("example.mount"));
}

TEST_F(ProjectCommand, TheCommandLineBeatsTheFile) {
  write_project("[cpp]\noutput = \"out\"\n[levels]\nunused = \"deny\"\n");
  folder_.write("other.robdef", "service other\nstdver 0.10\nimport example.base\n");
  EXPECT_EQ(run({"generate"}).status, 1) << "R0610 is denied";
  EXPECT_EQ(run({"generate", "--allow", "R0610"}).status, 0);
  EXPECT_TRUE(has("out/example/mount.hpp"));

  EXPECT_EQ(run({"generate", "other.robdef"}).status, 0) << "the import is found";
  EXPECT_TRUE(has("out/other.hpp")) << "inputs only are replaced";
  EXPECT_EQ(run({"generate", "--lang", "cpp", "-o", "mine", "other.robdef"}).status, 0);
  EXPECT_TRUE(has("mine/other.hpp"));
  EXPECT_EQ(run({"generate", "--lang", "typescript", "other.robdef"}).status, 0);
  EXPECT_TRUE(has("other.ts")) << "the file says nothing about TypeScript";
}

TEST_F(ProjectCommand, AnotherFileOrNoneCanBeRead) {
  write_project("[cpp]\noutput = \"out\"\n");
  folder_.write("sub/mine.toml", "inputs = [\"../shared/*.robdef\"]\n[cpp]\noutput = \"made\"\n");
  EXPECT_EQ(run({"generate", "--config", "sub/mine.toml"}).status, 0);
  EXPECT_TRUE(has("sub/made/example/base.hpp"));
  EXPECT_FALSE(has("out"));
  const Ended none = run({"check", "--no-config"});
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, StartsWith("robdef: no file given\n"));
  EXPECT_EQ(run({"check", "--no-config", "definitions/example.mount.robdef"}).status, 1)
      << "the import is not found";
  const Ended missing = run({"check", "--config", "nowhere.toml"});
  EXPECT_EQ(missing.status, 1);
  EXPECT_THAT(missing.err, HasSubstr("nowhere.toml"));
}

TEST_F(ProjectCommand, WhatIsMissingIsNamed) {
  EXPECT_THAT(run({"check"}).err, StartsWith("robdef: no file given\n`robdef check --help`"));
  EXPECT_THAT(run({"generate", "a"}).err, StartsWith("robdef: `--lang` is missing\n"));
  EXPECT_EQ(run({"generate", "a"}).status, 2);
  folder_.write("robdef.toml", "[levels]\n");
  EXPECT_THAT(run({"check"}).err, StartsWith("robdef: no file given; robdef.toml has no inputs\n"));
  EXPECT_THAT(
      run({"generate", "a"}).err,
      StartsWith("robdef: `--lang` is missing; robdef.toml says `output` of no language\n"));
  write_project("[cpp]\noutput = \"out\"\n");
  EXPECT_THAT(run({"generate", "-o", "x"}).err, StartsWith("robdef: `--output` needs `--lang`\n"));
}

TEST_F(ProjectCommand, AMistakeInTheFileIsAFindingAndNothingElseIsDone) {
  write_project("[cpp]\noutptu = \"out\"\n");
  const Ended ended = run({"generate", "--format=line"});
  EXPECT_EQ(ended.status, 1);
  EXPECT_EQ(ended.err, "robdef.toml(4,1): error: R0802 unknown key `outptu`\n");
  EXPECT_THAT(run({"check", "--format=json"}).out, HasSubstr("\"did you mean `output`?\""));
}

TEST_F(ProjectCommand, TheMakeRuleNamesTheProjectFileAndAllOutputs) {
  folder_.write("templates/x.mustache", "");
  write_project("[cpp]\noutput = \"out\"\ntemplates = \"templates\"\n");
  EXPECT_EQ(run({"generate", "--depfile", "x.d"}).status, 0);
  EXPECT_THAT(
      read_text(folder_ / "x.d"),
      AllOf(StartsWith("out/example/mount.cpp out/example/mount.hpp:"), HasSubstr(" robdef.toml "),
            HasSubstr("shared/example.base.robdef"), HasSubstr("templates/x.mustache")));
  EXPECT_EQ(run({"generate", "--list-outputs"}).out,
            "out/example/mount.cpp\nout/example/mount.hpp\n");
}

TEST_F(ProjectCommand, TwoLanguagesCannotWriteOneFile) {
  folder_.write("templates/outputs.txt", "all x.mustache x.txt\n");
  folder_.write("templates/x.mustache", "x\n");
  write_project(
      "[cpp]\noutput = \"out\"\ntemplates = \"templates\"\n"
      "[matlab]\noutput = \"out\"\ntemplates = \"templates\"\n");
  const Ended ended = run({"generate"});
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.err, HasSubstr("out/x.txt: two languages would write it"));
  EXPECT_FALSE(has("out"));
}

TEST_F(ProjectCommand, ARenameThatNamesNothingIsAFinding) {
  write_project(
      "[cpp]\noutput = \"out\"\n[cpp.rename]\n"
      "\"example.mount.Mount.nectar_ancor\" = \"old_anchor\"\n");
  const Ended ended = run({"generate"});
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.err,
              AllOf(HasSubstr("error[R0805]: cannot rename `example.mount.Mount.nectar_ancor`"),
                    HasSubstr("--> robdef.toml:6:1"),
                    HasSubstr("there is no `nectar_ancor` in example.mount.Mount"),
                    HasSubstr("help: did you mean `nectar_anchor`?")));
  EXPECT_EQ(run({"check", "--lang", "cpp"}).status, 1);

  write_project("[cpp]\noutput = \"out\"\n[cpp.rename]\n\"example.other.Thing\" = \"Item\"\n");
  EXPECT_EQ(run({"generate"}).status, 1) << "none of the inputs";
  EXPECT_EQ(run({"generate", "definitions/example.mount.robdef"}).status, 0)
      << "may be of another input";
}

TEST_F(ProjectCommand, CheckReportsWhatLanguagesCannotHave) {
  write_project("[csharp.rename]\n\"example.mount.Mount.nectar_anchor\" = \"second_anchor\"\n");
  const Ended ended = run({"check", "--lang", "csharp,typescript"});
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.err,
              AllOf(HasSubstr("error[R0901]: the TypeScript name"), Not(HasSubstr("the C# name"))));
  EXPECT_EQ(run({"check", "--lang=csharp"}).status, 0);
  EXPECT_EQ(run({"check", "--lang=csharp", "--no-config", "-I", "shared",
                 "definitions/example.mount.robdef"})
                .status,
            1);
  EXPECT_FALSE(has("example.mount.cs")) << "nothing is written";
  EXPECT_EQ(run({"check", "--lang=csharp,cp"}).status, 2);
}

TEST_F(ProjectCommand, ADeniedWarningIsAnErrorThatACommentCanAllow) {
  write_project("");
  const Ended denied = run({"check", "--deny", "warnings"});
  EXPECT_EQ(denied.status, 1);
  EXPECT_THAT(denied.err, AllOf(HasSubstr("error[R0610]"), HasSubstr("\n1 error\n")));
  EXPECT_EQ(run({"check", "--deny", "warnings", "--warn", "R0610"}).status, 0);
  folder_.write("definitions/example.mount.robdef",
                "service example.mount\nstdver 0.10\nobject Mount\n    # robdef: allow R0610\n"
                "    property double x [shiny]\nend\n");
  const Ended allowed = run({"check", "--deny", "warnings"});
  EXPECT_EQ(allowed.status, 0);
  EXPECT_EQ(allowed.err, "");
}

class StaleOutputs : public ProjectCommand {
 protected:
  StaleOutputs() {
    write_project("[cpp]\noutput = \"out\"\n[arduino]\noutput = \"out\"\n");
    folder_.write("definitions/example.mount.robdef",
                  "service example.mount\nstdver 0.10\nobject Mount\n    property double x\nend\n");
    folder_.write("definitions/example.old.robdef",
                  "service example.old\nstdver 0.10\nobject Old\n    property double x\nend\n");
    const Ended first = run({"generate"});
    EXPECT_EQ(first.status, 0) << first.err;
    EXPECT_TRUE(has("out/example/old.hpp"));
    EXPECT_TRUE(has("out/example_old/example_old.ino"));
    EXPECT_TRUE(has("out/.robdef-cpp.manifest"));
    EXPECT_TRUE(has("out/.robdef-arduino.manifest"));
    std::filesystem::remove(folder_.path() / "definitions/example.old.robdef");
  }
};

TEST_F(StaleOutputs, AreRemovedButForWhatTheUserGoesOnWith) {
  folder_.write("out/example/mine.hpp", "mine");
  EXPECT_EQ(run({"generate"}).status, 0);
  EXPECT_FALSE(has("out/example/old.hpp"));
  EXPECT_FALSE(has("out/example/old.cpp"));
  EXPECT_FALSE(has("out/example_old/example_old.h"));
  EXPECT_TRUE(has("out/example_old/example_old.ino")) << "a sketch is the user's";
  EXPECT_TRUE(has("out/example/mine.hpp"));
  EXPECT_TRUE(has("out/example/mount.hpp"));
}

TEST_F(StaleOutputs, StayWhenTheyWereEditedAndAreNamedEachTime) {
  folder_.write("out/example/old.hpp", "edited");
  for (int time = 0; time < 2; ++time) {
    const Ended ended = run({"generate"});
    EXPECT_EQ(ended.status, 0);
    EXPECT_THAT(ended.err, HasSubstr("robdef: warning: out/example/old.hpp is no longer generated, "
                                     "and was edited"));
  }
  EXPECT_TRUE(has("out/example/old.hpp"));
  EXPECT_FALSE(has("out/example/old.cpp"));
  std::filesystem::remove(folder_.path() / "out/example/old.hpp");
  EXPECT_THAT(run({"generate"}).err, Not(HasSubstr("old.hpp")));
}

TEST_F(StaleOutputs, StayInRunsOfAPartAndInThoseThatFail) {
  EXPECT_EQ(run({"generate", "definitions/example.mount.robdef"}).status, 0);
  EXPECT_EQ(run({"generate", "--lang", "cpp"}).status, 0);
  EXPECT_TRUE(has("out/example/old.hpp"));
  folder_.write("definitions/example.wrong.robdef", "service example.wrong\nfoo\n");
  EXPECT_EQ(run({"generate"}).status, 1);
  EXPECT_TRUE(has("out/example/old.hpp"));
}

}  // namespace
}  // namespace robdef
