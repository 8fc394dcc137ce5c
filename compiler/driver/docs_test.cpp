// SPDX-License-Identifier: Apache-2.0
// robdef docs, as a user runs it: which files are written, and when none is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "compiler/driver/program.hpp"

namespace robdef {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr std::string_view base_text =
    "service example.base\nstdver 0.10\n\n## Two angles.\nstruct Angles\n    field double "
    "pan\nend\n";
constexpr std::string_view mount_text =
    "service example.mount\nstdver 0.10\nimport example.base\nusing example.base.Angles\n\n"
    "object Mount\n    ## Where it points.\n    property Angles angles\nend\n";
constexpr std::string_view bad_text =
    "service bad\nstdver 0.10\nstruct S\n    field Angle x\nend\n";

class DocsCommand : public testing::Test {
 protected:
  DocsCommand() {
    folder_.write("example.base.robdef", base_text);
    folder_.write("example.mount.robdef", mount_text);
  }
  Ended run(std::vector<std::string> arguments, const std::string& input = "") {
    arguments.insert(arguments.begin(), "docs");
    return run_robdef(folder_, arguments, "", input);
  }
  [[nodiscard]] std::vector<std::string> written() const {
    std::vector<std::string> files;
    for (const std::string& file : folder_.files()) {
      if (file.starts_with("out/")) files.push_back(file);
    }
    return files;
  }
  [[nodiscard]] std::string text(const std::string& file) const {
    return read_text(folder_.path() / file);
  }

  TemporaryFolder folder_;
};

TEST_F(DocsCommand, WritesAPageForEachDefinitionAndItsImports) {
  const Ended ended = run({"-o", "out", "example.mount.robdef"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.out + ended.err, "");
  EXPECT_THAT(written(), ElementsAre("out/example.base.html", "out/example.mount.html",
                                     "out/index.html", "out/search.js"));
  EXPECT_THAT(text("out/example.mount.html"),
              AllOf(StartsWith("<!DOCTYPE html>\n"), HasSubstr("<p>Where it points.</p>"),
                    HasSubstr("<a href=\"example.base.html#Angles\">Angles</a>")));
  EXPECT_THAT(text("out/example.base.html"), HasSubstr("language version 0.10, imported</p>"));
  EXPECT_THAT(text("out/example.mount.html"), Not(HasSubstr(", imported</p>")));
}

TEST_F(DocsCommand, WritesMarkdown) {
  const Ended ended = run({"--format", "markdown", "--output=out/deep", "example.mount.robdef"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(written(), ElementsAre("out/deep/example.base.md", "out/deep/example.mount.md",
                                     "out/deep/index.md"));
  EXPECT_THAT(text("out/deep/example.mount.md"), HasSubstr("[Angles](example.base.md#Angles)"));
}

TEST_F(DocsCommand, ListOutputsPrintsThePathsAndWritesNothing) {
  const Ended ended = run({"-o", "out", "--list-outputs", "example.base.robdef"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.out, "out/example.base.html\nout/index.html\nout/search.js\n");
  EXPECT_THAT(written(), ElementsAre());
}

TEST_F(DocsCommand, DepfileNamesPagesAndDefinitions) {
  const Ended ended =
      run({"--format=markdown", "-o", "out", "--depfile", "x.d", "example.mount.robdef"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(text("x.d"),
            "out/example.base.md out/example.mount.md out/index.md: \\\n"
            "  example.mount.robdef \\\n  example.base.robdef\n");
}

TEST_F(DocsCommand, WithoutFilesTheInputsOfTheProjectAreTaken) {
  folder_.write("robdef.toml", "inputs = [\"example.b*.robdef\"]\n[cpp]\noutput = \"code\"\n");
  const Ended ended = run({"-o", "out", "--format=markdown"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(written(), ElementsAre("out/example.base.md", "out/index.md"));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "code"));
}

TEST_F(DocsCommand, StandardInputIsADefinition) {
  const Ended ended = run({"-o", "out", "--format=markdown", "-"}, std::string(base_text));
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(text("out/example.base.md"), HasSubstr("Two angles."));
}

TEST_F(DocsCommand, ADefinitionWithMistakesGivesItsErrorsAndNoPage) {
  folder_.write("bad.robdef", bad_text);
  const Ended ended = run({"-o", "out", "example.mount.robdef", "bad.robdef"});
  EXPECT_EQ(ended.status, 1);
  EXPECT_EQ(ended.out, "");
  EXPECT_THAT(ended.err, AllOf(HasSubstr("error[R0203]: unknown type `Angle`"),
                               HasSubstr("--> bad.robdef:4:11"), HasSubstr("\n1 error\n")));
  EXPECT_THAT(written(), ElementsAre());
}

TEST_F(DocsCommand, WarningsCanBeDenied) {
  folder_.write("a.robdef",
                "service a\nstdver 0.10\nobject O\n    property double x [shiny]\nend\n");
  EXPECT_EQ(run({"-o", "out", "--deny=R0610", "a.robdef"}).status, 1);
  EXPECT_THAT(written(), ElementsAre());
  const Ended ended = run({"-o", "out", "a.robdef"});
  EXPECT_EQ(ended.status, 0);
  EXPECT_THAT(ended.err, HasSubstr("warning[R0610]"));
  EXPECT_THAT(text("out/a.html"), HasSubstr("<code>shiny</code> is no modifier of the language."));
}

TEST_F(DocsCommand, AFolderThatCannotBeWrittenIsAnErrorAndNothingIsWritten) {
  folder_.write("out", "a file where the folder should be\n");
  const std::vector<std::string> before = folder_.files();
  const Ended ended = run({"-o", "out", "example.mount.robdef"});
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.err, AllOf(StartsWith("robdef: "), HasSubstr("out")));
  EXPECT_EQ(folder_.files(), before);
}

TEST_F(DocsCommand, OnePageThatCannotBeWrittenKeepsAllOthersAsTheyWere) {
  folder_.write("out/index.html/is_a_folder", "");
  const std::vector<std::string> before = folder_.files();
  const Ended ended = run({"-o", "out", "example.mount.robdef"});
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.err, HasSubstr("out/index.html"));
  EXPECT_EQ(folder_.files(), before);
}

TEST_F(DocsCommand, ASecondRunTouchesNothing) {
  ASSERT_EQ(run({"-o", "out", "example.mount.robdef", "example.base.robdef"}).status, 0);
  const auto old = std::filesystem::file_time_type::clock::now() - std::chrono::hours(1);
  for (const std::string& file : written()) {
    std::filesystem::last_write_time(folder_.path() / file, old);
  }
  ASSERT_EQ(run({"-o", "out", "example.base.robdef", "example.mount.robdef"}).status, 0);
  for (const std::string& file : written()) {
    EXPECT_EQ(std::filesystem::last_write_time(folder_.path() / file), old) << file;
  }
}

TEST_F(DocsCommand, WrongUseSaysWhatIsMissing) {
  const Ended folder = run({"example.mount.robdef"});
  EXPECT_EQ(folder.status, 2);
  EXPECT_THAT(folder.err, StartsWith("robdef: `--output` is missing\n`robdef docs --help`"));
  const Ended form = run({"--format=pdf", "-o", "out", "example.mount.robdef"});
  EXPECT_EQ(form.status, 2);
  EXPECT_THAT(form.err, HasSubstr("unknown format `pdf`; known: `html`, `markdown`"));
  EXPECT_EQ(run({"-o", "out"}).status, 2);
  EXPECT_THAT(run({"-o", "out"}).err, StartsWith("robdef: no file given\n"));
  EXPECT_THAT(run({"-o", "out", "--lang=cpp", "a.robdef"}).err,
              StartsWith("robdef: `robdef docs` has no option `--lang`\n"));
}

}  // namespace
}  // namespace robdef
