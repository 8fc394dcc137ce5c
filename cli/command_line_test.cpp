// SPDX-License-Identifier: Apache-2.0
// Runs the built program as a user does.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "compiler/driver/program.hpp"

namespace robdef {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

constexpr std::string_view base_text =
    "service example.base\nstdver 0.10\n\n"
    "## Two angles.\nstruct Angles\n    field double pan\n    field double tilt\nend\n";
constexpr std::string_view mount_text =
    "service example.mount\nstdver 0.10\nimport example.base\nusing example.base.Angles\n\n"
    "## A mount that turns.\nobject Mount\n    ## Where it points.\n    property Angles angles\n"
    "    function void move_to(double pan, double tilt)\nend\n";

class CommandLine : public testing::Test {
 protected:
  Ended run(const std::vector<std::string>& arguments, const std::string& variable = "",
            const std::string& input = "") {
    return run_robdef(folder_, arguments, variable, input);
  }
  void write_definitions() {
    folder_.write("example.base.robdef", base_text);
    folder_.write("example.mount.robdef", mount_text);
  }
  std::map<std::string, std::filesystem::file_time_type> times() const {
    std::map<std::string, std::filesystem::file_time_type> result;
    for (const std::string& file : folder_.files()) {
      result[file] = std::filesystem::last_write_time(folder_.path() / file);
    }
    return result;
  }

  TemporaryFolder folder_;
};

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = text.find('\n', begin);
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

TEST_F(CommandLine, VersionAndHelpAreAnswersNotErrors) {
  EXPECT_THAT(run({"--version"}).out, StartsWith("robdef "));
  const Ended help = run({"--help"});
  EXPECT_EQ(help.status, 0);
  EXPECT_THAT(help.out, StartsWith("usage: robdef COMMAND"));
  EXPECT_EQ(help.err, "");
}

TEST_F(CommandLine, WrongUseIsStatusTwoOnStandardError) {
  const Ended ended = run({"generate", "--lnag", "cpp", "x.robdef"});
  EXPECT_EQ(ended.status, 2);
  EXPECT_EQ(ended.out, "");
  EXPECT_THAT(ended.err, StartsWith("robdef: unknown option `--lnag`; did you mean `--lang`?\n"));
}

TEST_F(CommandLine, CheckOfAGoodDefinitionIsSilent) {
  write_definitions();
  const Ended ended = run({"check", "example.mount.robdef"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.out + ended.err, "");
}

TEST_F(CommandLine, CheckReportsErrorsOfAllFilesOnStandardError) {
  folder_.write("a.robdef", "service a\nstdver 0.10\nstruct S\n    field Angle x\nend\n");
  folder_.write("b.robdef", "service b\nstdver 0.10\nobject O\n    property doble y\nend\n");
  const Ended ended = run({"check", "a.robdef", "b.robdef"});
  EXPECT_EQ(ended.status, 1);
  EXPECT_EQ(ended.out, "");
  EXPECT_THAT(ended.err, AllOf(HasSubstr("error[R0203]"), HasSubstr("--> a.robdef:4:11"),
                               HasSubstr("--> b.robdef:4:14"), HasSubstr("\n2 errors\n")));
}

TEST_F(CommandLine, FindingsComeInOneLineFormToo) {
  folder_.write("a.robdef", "service a\nstdver 0.10\nstruct S\n    field Angle x\nend\n");
  const Ended ended = run({"check", "--format=line", "a.robdef"});
  EXPECT_EQ(ended.status, 1);
  EXPECT_EQ(lines_of(ended.err).size(), 1U) << ended.err;
  EXPECT_THAT(ended.err, StartsWith("a.robdef(4,11): error: R0203"));
}

TEST_F(CommandLine, FindingsAsJsonGoToStandardOutput) {
  folder_.write("a.robdef", "service a\nstdver 0.10\nstruct S\n    field Angle x\nend\n");
  const Ended ended = run({"check", "--format=json", "a.robdef"});
  EXPECT_EQ(ended.status, 1);
  EXPECT_EQ(ended.err, "");
  EXPECT_THAT(ended.out, AllOf(StartsWith("["), HasSubstr("\"code\": \"R0203\""),
                               HasSubstr("\"rule\": \"V12\""), HasSubstr("\"line\": 4")));
  write_definitions();
  EXPECT_EQ(run({"check", "--format=json", "example.mount.robdef"}).out, "[]\n");
}

TEST_F(CommandLine, AWarningLeavesStatusZeroAndCanBeTurnedOff) {
  folder_.write("a.robdef",
                "service a\nstdver 0.10\nobject O\n    property double x [shiny]\nend\n");
  const Ended loud = run({"check", "a.robdef"});
  EXPECT_EQ(loud.status, 0);
  EXPECT_THAT(loud.err, AllOf(HasSubstr("warning[R0610]"), HasSubstr("\n1 warning\n")));
  const Ended quiet = run({"check", "--no-warning=R0610", "a.robdef"});
  EXPECT_EQ(quiet.status, 0);
  EXPECT_EQ(quiet.err, "");
}

TEST_F(CommandLine, WhatIsFoundTwiceAtOnePlaceCountsOnce) {
  folder_.write("a.robdef",
                "service a\nstdver 0.10\nstruct S\n    field double{string} m\nend\n"
                "object O\n    property S x\n    property S y\nend\n");
  const Ended ended = run({"generate", "--lang", "arduino", "a.robdef"});
  EXPECT_EQ(ended.status, 1);
  std::size_t shown = 0;
  for (std::size_t at = 0; (at = ended.err.find("error[R", at)) != std::string::npos; ++at) ++shown;
  EXPECT_GE(shown, 1U);
  EXPECT_THAT(ended.err,
              HasSubstr("\n" + std::to_string(shown) + (shown == 1 ? " error\n" : " errors\n")));
  EXPECT_THAT(ended.err, Not(HasSubstr("warning")));
}

TEST_F(CommandLine, StrictAsksForAVersion) {
  folder_.write("a.robdef", "service a\nobject O\n    property double x\nend object\n");
  EXPECT_EQ(run({"check", "a.robdef"}).status, 0);
  const Ended ended = run({"check", "--strict", "a.robdef"});
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.err, HasSubstr("R0135"));
}

TEST_F(CommandLine, AMissingFileIsAnErrorWithItsName) {
  const Ended ended = run({"check", "nowhere.robdef"});
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.err, AllOf(HasSubstr("R0509"), HasSubstr("nowhere.robdef")));
}

TEST_F(CommandLine, ImportsAreFoundBesideTheFileInFoldersAndInTheEnvironment) {
  folder_.write("far/example.base.robdef", base_text);
  folder_.write("example.mount.robdef", mount_text);
  EXPECT_EQ(run({"check", "example.mount.robdef"}).status, 1);
  EXPECT_EQ(run({"check", "-I", "far", "example.mount.robdef"}).status, 0);
  EXPECT_EQ(run({"check", "example.mount.robdef"}, "no-folder:far").status, 0);
  folder_.write("example.base.robdef", base_text);
  EXPECT_EQ(run({"check", "example.mount.robdef"}).status, 0);
  EXPECT_EQ(run({"check", folder_ / "example.mount.robdef"}).status, 0);
}

TEST_F(CommandLine, GenerateWritesExactlyWhatListOutputsPrints) {
  write_definitions();
  const std::vector<std::string> before = folder_.files();
  const Ended list =
      run({"generate", "--lang", "cpp", "-o", "out", "--list-outputs", "example.mount.robdef"});
  EXPECT_EQ(list.status, 0) << list.err;
  EXPECT_EQ(folder_.files(), before);

  const Ended ended = run({"generate", "--lang", "cpp", "-o", "out", "example.mount.robdef"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.out + ended.err, "");
  std::vector<std::string> written;
  for (const std::string& file : folder_.files()) {
    if (file.starts_with("out/")) written.push_back(file);
  }
  std::vector<std::string> listed = lines_of(list.out);
  std::sort(listed.begin(), listed.end());
  EXPECT_EQ(listed, written);
  EXPECT_THAT(written, ElementsAre("out/example/mount.cpp", "out/example/mount.hpp"));
}

TEST_F(CommandLine, TypeScriptHasOneModuleForEachDefinition) {
  write_definitions();
  const Ended ended =
      run({"generate", "--lang", "typescript", "-o", "out", "example.mount.robdef"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  const std::string text = read_text(folder_.path() / "out/example.mount.ts");
  EXPECT_THAT(text, HasSubstr("export class MountStub extends rr.Stub implements Mount {"));
  EXPECT_THAT(text, HasSubstr("from \"./example.base.js\";"));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "out/example.base.ts"));
  EXPECT_THAT(run({"--help"}).out, HasSubstr("\n  typescript "));
}

TEST_F(CommandLine, TwoRunsGiveTheSameBytesAndTheSecondTouchesNothing) {
  write_definitions();
  const std::vector<std::string> arguments = {
      "generate", "--lang", "cpp", "-o", "out", "example.mount.robdef", "example.base.robdef"};
  ASSERT_EQ(run(arguments).status, 0);
  const auto old = std::filesystem::file_time_type::clock::now() - std::chrono::hours(1);
  for (const std::string& file : folder_.files()) {
    std::filesystem::last_write_time(folder_.path() / file, old);
  }
  const auto before = times();
  ASSERT_EQ(run(arguments).status, 0);
  EXPECT_EQ(times(), before);

  folder_.write("out/example/mount.hpp", "changed by hand\n");
  ASSERT_EQ(run(arguments).status, 0);
  EXPECT_THAT(read_text(folder_.path() / "out/example/mount.hpp"), HasSubstr("class MountStub"));
  EXPECT_EQ(times()["out/example/mount.cpp"], before.at("out/example/mount.cpp"));
}

TEST_F(CommandLine, NothingIsWrittenWhenOneOfTheFilesHasAnError) {
  write_definitions();
  folder_.write("bad.robdef", "service bad\nstdver 0.10\nstruct S\n    field Angle x\nend\n");
  const std::vector<std::string> before = folder_.files();
  const Ended ended = run({"generate", "--lang", "cpp", "-o", "out", "--depfile", "out/x.d",
                           "example.mount.robdef", "bad.robdef"});
  EXPECT_EQ(ended.status, 1);
  EXPECT_EQ(folder_.files(), before);
}

TEST_F(CommandLine, NothingIsWrittenWhenTheFolderCannotBe) {
  write_definitions();
  folder_.write("out", "a file where the folder should be\n");
  const std::vector<std::string> before = folder_.files();
  const Ended ended = run({"generate", "--lang", "cpp", "-o", "out", "example.mount.robdef"});
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.err, AllOf(StartsWith("robdef: "), HasSubstr("out")));
  EXPECT_EQ(folder_.files(), before);
}

TEST_F(CommandLine, DepfileNamesOutputsAndEveryFileThatWasRead) {
  write_definitions();
  const Ended ended =
      run({"generate", "--lang=cpp", "-oout", "--depfile", "deps/mount.d", "example.mount.robdef"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(read_text(folder_.path() / "deps/mount.d"),
            "out/example/mount.cpp out/example/mount.hpp: \\\n"
            "  example.mount.robdef \\\n  example.base.robdef\n");
  ASSERT_EQ(run({"generate", "--lang=cpp", "-oout", "--depfile", "deps/mount.d", "--depfile-target",
                 "mount.stamp", "example.mount.robdef"})
                .status,
            0);
  EXPECT_THAT(read_text(folder_.path() / "deps/mount.d"), StartsWith("mount.stamp: \\\n"));
}

TEST_F(CommandLine, DescribeModelAndViewPrintOneProductToStandardOutput) {
  write_definitions();
  const Ended outline = run({"describe", "example.mount.robdef"});
  EXPECT_EQ(outline.status, 0) << outline.err;
  EXPECT_THAT(outline.out, AllOf(HasSubstr("example.mount"), HasSubstr("move_to"),
                                 HasSubstr("Where it points.")));
  const Ended model = run({"model", "example.mount.robdef"});
  EXPECT_EQ(model.status, 0) << model.err;
  EXPECT_THAT(model.out, AllOf(StartsWith("{"), HasSubstr("\"example.base\"")));
  EXPECT_EQ(run({"model", "example.mount.robdef"}).out, model.out);
  const Ended view = run({"view", "--lang", "cpp", "example.mount.robdef"});
  EXPECT_EQ(view.status, 0) << view.err;
  EXPECT_THAT(view.out, HasSubstr("\"MountStub\""));
}

TEST_F(CommandLine, AProductIsNotPrintedForADefinitionWithErrors) {
  folder_.write("a.robdef", "service a\nstdver 0.10\nstruct S\n    field Angle x\nend\n");
  for (const std::string command : {"describe", "model"}) {
    const Ended ended = run({command, "--format=json", "a.robdef"});
    EXPECT_EQ(ended.status, 1);
    EXPECT_EQ(ended.out, "");
    EXPECT_THAT(ended.err, HasSubstr("\"code\": \"R0203\""));
  }
}

TEST_F(CommandLine, TheSeedPapersDialectCompiles) {
  folder_.write("room.robdef",
                "service Room\n\nstruct Size\n    field double width\nend struct\n\n"
                "object Room\n    property Size size\nend object\n");
  const Ended ended = run({"generate", "--lang", "cpp", "-o", "out", "room.robdef"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(folder_.files(), ElementsAre("out/Room.cpp", "out/Room.hpp", "room.robdef"));
}

TEST_F(CommandLine, AFaultInAGivenTemplateIsTheUsersAndNamesTheTemplate) {
  write_definitions();
  folder_.write("templates/outputs.txt", "definition x.txt.mustache x.txt\n");
  folder_.write("templates/x.txt.mustache", "{{no_such_name}}\n");
  const Ended ended = run({"generate", "--lang", "cpp", "--templates", "templates", "-o", "out",
                           "example.mount.robdef"});
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.err, HasSubstr("x.txt.mustache"));
  EXPECT_THAT(ended.out, IsEmpty());
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "out"));
}

TEST_F(CommandLine, AFullStandardOutputIsAnError) {
  write_definitions();
  const std::string command = "cd '" + folder_.path().string() +
                              "' && '" ROBDEF_PROGRAM
                              "' model example.mount.robdef >/dev/full 2>err.txt";
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 1);
  EXPECT_THAT(read_text(folder_.path() / "err.txt"),
              HasSubstr("standard output cannot be written"));
}

TEST_F(CommandLine, ADashIsStandardInput) {
  write_definitions();
  EXPECT_EQ(run({"check", "-"}, "", std::string(mount_text)).status, 0) << "imports from here";
  const Ended bad = run({"check", "--format=line", "-"}, "", "service a\nfoo\n");
  EXPECT_EQ(bad.status, 1);
  EXPECT_THAT(bad.err, StartsWith("<stdin>(2,1): error: R0107"));
  const Ended ended = run({"generate", "--lang=cpp", "-o", "out", "--depfile", "x.d", "-"}, "",
                          std::string(mount_text));
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "out/example/mount.hpp"));
  EXPECT_THAT(read_text(folder_.path() / "x.d"),
              AllOf(HasSubstr("example.base.robdef"), Not(HasSubstr("stdin"))));
  EXPECT_THAT(run({"inspect", "-"}, "", "no recording").err, Not(HasSubstr("No such file")));
  EXPECT_EQ(run({"inspect", "-"}, "", "no recording").status, 1);
}

TEST_F(CommandLine, HelpForAnImportDoesNotProposeTheFileThatImports) {
  folder_.write("b.robdef", "service other\nstdver 0.10\nimport b\n");
  const Ended ended = run({"check", "b.robdef"});
  EXPECT_THAT(ended.err, HasSubstr("help: write `service b` if this file is meant, and no import"));
  EXPECT_THAT(ended.err, Not(HasSubstr("import `other`")));
}

TEST_F(CommandLine, OutputsAndTheMakeRuleAreWrittenTogetherOrNotAtAll) {
  write_definitions();
  folder_.write("deps/x.d/is_a_folder", "");
  const std::vector<std::string> before = folder_.files();
  const Ended ended =
      run({"generate", "--lang=cpp", "-o", "out", "--depfile", "deps/x.d", "example.mount.robdef"});
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.err, HasSubstr("deps/x.d"));
  EXPECT_EQ(folder_.files(), before);
}

TEST_F(CommandLine, AReadErrorSaysTheSystemsReason) {
  folder_.write("a.robdef", "service a\n");
  EXPECT_THAT(run({"check", "a.robdef/b"}).err, HasSubstr("cannot be read: Not a directory"));
  EXPECT_THAT(run({"format", "a.robdef/b"}).err, HasSubstr("cannot be read: Not a directory"));
}

TEST_F(CommandLine, ANameOfAMegabyteIsNotPrintedWhole) {
  const std::string name(1'000'000, 'x');
  folder_.write("a.robdef", "service a\nstdver 0.10\nimport " + name + "\nobject O\nproperty " +
                                name + " y\nproperty double " + name + "\nproperty double " + name +
                                "\nend\n");
  for (const std::string form : {"text", "line", "json"}) {
    const Ended ended = run({"check", "--format=" + form, "a.robdef"});
    EXPECT_EQ(ended.status, 1);
    EXPECT_LT(ended.out.size() + ended.err.size(), 20'000U) << form;
  }
}

constexpr std::string_view untidy = "service a\nstdver 0.10\nobject O\nproperty  double x\nend";
constexpr std::string_view tidy =
    "service a\n\nstdver 0.10\n\nobject O\n    property double x\nend\n";

TEST_F(CommandLine, FormatLaysOutFilesInTheirPlaces) {
  folder_.write("a.robdef", untidy);
  folder_.write("sub/b.robdef", tidy);
  std::filesystem::create_symlink("../a.robdef", folder_.path() / "sub/link.robdef");
  const auto before = times();
  const Ended ended = run({"format", "sub/link.robdef", "a.robdef", "sub/b.robdef"});
  EXPECT_EQ(ended.status, 0);
  EXPECT_EQ(ended.out + ended.err, "");
  EXPECT_EQ(read_text(folder_.path() / "a.robdef"), tidy);
  EXPECT_TRUE(std::filesystem::is_symlink(folder_.path() / "sub/link.robdef"));
  EXPECT_EQ(times().at("sub/b.robdef"), before.at("sub/b.robdef")) << "it had the layout";
  EXPECT_EQ(times().size(), before.size()) << "no file is left beside";
}

TEST_F(CommandLine, FormatCheckNamesWhatWouldChange) {
  folder_.write("a.robdef", untidy);
  folder_.write("b.robdef", tidy);
  const Ended ended = run({"format", "--check", "a.robdef", "b.robdef"});
  EXPECT_EQ(ended.status, 1);
  EXPECT_EQ(ended.out,
            "a.robdef:2:1: blank line missing above\na.robdef:3:1: blank line missing above\n"
            "a.robdef:4:1: indentation\na.robdef:4:9: blanks between words\n"
            "a.robdef:5:4: line end missing at the end of the file\n");
  EXPECT_EQ(read_text(folder_.path() / "a.robdef"), untidy);
  EXPECT_EQ(run({"format", "--check", "b.robdef"}).status, 0);
  EXPECT_EQ(run({"format", "--check", "-"}, "", std::string(untidy)).status, 1);
}

TEST_F(CommandLine, FormatOfStandardInputGoesToStandardOutput) {
  const Ended ended = run({"format", "-"}, "", std::string(untidy));
  EXPECT_EQ(ended.status, 0);
  EXPECT_EQ(ended.out, tidy);
  EXPECT_THAT(folder_.files(), IsEmpty());
}

TEST_F(CommandLine, FormatWritesNothingWhenOneFileCannotBeRead) {
  folder_.write("a.robdef", untidy);
  const Ended ended = run({"format", "a.robdef", "nowhere.robdef"});
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.err, HasSubstr("nowhere.robdef: cannot be read: No such file"));
  EXPECT_EQ(read_text(folder_.path() / "a.robdef"), untidy);
}

TEST_F(CommandLine, FormatNamesLinesThatItLeaves) {
  folder_.write("a.robdef", "service a\n\nobject O\n  foo  bar\nevent e( )\nend\n");
  const Ended ended = run({"format", "a.robdef"});
  EXPECT_EQ(ended.status, 0);
  EXPECT_EQ(ended.err, "a.robdef:4: left as it is, because it cannot be read\n");
  EXPECT_EQ(read_text(folder_.path() / "a.robdef"),
            "service a\n\nobject O\n  foo  bar\n    event e()\nend\n");
}

}  // namespace
}  // namespace robdef
