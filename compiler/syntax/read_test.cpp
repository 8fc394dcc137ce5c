// SPDX-License-Identifier: Apache-2.0
#include "compiler/syntax/read.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "compiler/diagnostics/golden_corpus.hpp"
#include "compiler/diagnostics/render.hpp"

namespace robdef::ast {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const fs::path read_corpus = fs::path(ROBDEF_CORPUS_DIR) / "read";

class ReadTest : public ::testing::Test {
 protected:
  ReadTest()
      : folder_(fs::path(::testing::TempDir()) /
                ("read_" + std::to_string(::getpid()) + "_" +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::create_directories(folder_);
  }
  ~ReadTest() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return (folder_ / name).string();
  }

  Program read_files(const std::vector<std::string>& inputs, const SearchPath& path = {}) {
    return ast::read(inputs, path, sources_, report_);
  }

  [[nodiscard]] std::string findings() const { return render(report_, sources_, Format::line); }

  fs::path folder_;
  Sources sources_;
  Report report_;
};

// `name` for a source, `(name)` for an import.
std::vector<std::string> services(const Program& program) {
  std::vector<std::string> result;
  for (const ProgramFile& file : program.files) {
    const std::string name = file.file.service ? file.file.service->text : "?";
    result.push_back(file.is_import ? "(" + name + ")" : name);
  }
  return result;
}

TEST_F(ReadTest, ImportsAreFoundBesideTheFileThatImports) {
  const std::string input = write("sub/a.robdef", "service a\nimport b\n");
  write("sub/b.robdef", "service b\nimport c.d\n");
  write("sub/c.d.robdef", "service c.d\n");
  EXPECT_THAT(services(read_files({input})), ElementsAre("a", "(b)", "(c.d)"));
  EXPECT_EQ(findings(), "");
}

TEST_F(ReadTest, ImportsAreFoundAlongThePathInItsOrder) {
  const std::string input = write("a.robdef", "service a\nimport b\nimport c\n");
  write("one/b.robdef", "service b\n");
  write("two/b.robdef", "service b\nimport nowhere\n");
  write("two/c.robdef", "service c\n");
  const std::string one = (folder_ / "one").string();
  const std::string two = (folder_ / "two").string();
  EXPECT_THAT(services(read_files({input}, make_search_path({one}, two))),
              ElementsAre("a", "(b)", "(c)"));
  EXPECT_EQ(sources_[SourceId{1}].name(), one + "/b.robdef");
}

TEST_F(ReadTest, WhatIsGivenAsASourceIsNotSearched) {
  const std::string a = write("a.robdef", "service a\nimport b\n");
  const std::string b = write("elsewhere/other_name.robdef", "service b\nimport a\n");
  write("b.robdef", "service b\nthis is not read\n");
  EXPECT_THAT(services(read_files({a, b})), ElementsAre("a", "b"));
  EXPECT_EQ(findings(), "");
}

TEST_F(ReadTest, SourcesComeFirstAndImportsAsTheyAreMet) {
  const std::string a = write("a.robdef", "service a\nimport x\nimport y\n");
  const std::string b = write("b.robdef", "service b\nimport y\nimport z\n");
  write("x.robdef", "service x\nimport w\n");
  for (const std::string name : {"w", "y", "z"}) write(name + ".robdef", "service " + name + "\n");
  EXPECT_THAT(services(read_files({a, b})), ElementsAre("a", "b", "(x)", "(y)", "(z)", "(w)"));
}

TEST_F(ReadTest, CirclesEndAndMissingImportsAreLeftOut) {
  const Program program = read_files({(read_corpus / "circle_a.robdef").string()});
  EXPECT_THAT(services(program), ElementsAre("circle_a", "(circle_b)"));
  EXPECT_EQ(findings(), "");
  EXPECT_FALSE(program.files[0].file.imports[1].is_reported);
}

TEST_F(ReadTest, AFileGivenTwiceIsReadOnce) {
  const std::string input = write("a.robdef", "service a\n");
  EXPECT_THAT(services(read_files({input, input, (folder_ / "." / "a.robdef").string()})),
              ElementsAre("a"));
  EXPECT_EQ(findings(), "");
}

TEST_F(ReadTest, AMissingInputIsReportedAndTheOthersAreRead) {
  const std::string input = write("a.robdef", "service a\n");
  EXPECT_THAT(services(read_files({"no/such/file.robdef", input})), ElementsAre("a"));
  EXPECT_EQ(findings(),
            "no/such/file.robdef(1,1): error: R0509 there is no file "
            "`no/such/file.robdef`\n");
}

TEST_F(ReadTest, AFolderCannotBeRead) {
  EXPECT_THAT(read_files({folder_.string()}).files, IsEmpty());
  EXPECT_THAT(findings(), HasSubstr(": error: R0510 `" + folder_.string() +
                                    "` cannot be read: Is a directory\n"));
}

TEST_F(ReadTest, TheSystemsReasonIsTold) {
  const std::string input = write("a.robdef", "service a\n");
  const std::string name(300, 'x');
  EXPECT_THAT(read_files({input + "/b.robdef", name}).files, IsEmpty());
  EXPECT_THAT(findings(), HasSubstr("cannot be read: Not a directory\n"));
  EXPECT_THAT(findings(), HasSubstr("cannot be read: File name too long\n"));
}

TEST_F(ReadTest, AFileThatIsTooLargeIsReportedWithItsLimit) {
  const std::string large = write("large.robdef", "service large\n");
  fs::resize_file(large, (std::uintmax_t{64} << 20U) + 1);
  const std::string input = write("a.robdef", "service a\nimport large\n");
  EXPECT_THAT(services(read_files({input, large})), ElementsAre("a"));
  const std::string text =
      ": error: R0510 `" + large + "` cannot be read: it is larger than 64 MiB\n";
  EXPECT_EQ(findings(), input + "(2,8)" + text + large + "(1,1)" + text);
}

TEST_F(ReadTest, AnUnreadableImportIsReportedWhereItIsImported) {
  const Program program = read_files({(read_corpus / "R0510_unreadable.robdef").string()});
  EXPECT_TRUE(program.files[0].file.imports[0].is_reported);
  EXPECT_THAT(findings(), HasSubstr("R0510_unreadable.robdef(3,8): error: R0510 "));
}

TEST_F(ReadTest, AnImportOfAFileWithAnotherServiceIsReportedAndNotLoaded) {
  const Program program = read_files({(read_corpus / "R0512_other_service.robdef").string()});
  EXPECT_THAT(services(program), ElementsAre("example.reads"));
  EXPECT_TRUE(program.files[0].file.imports[0].is_reported);
  EXPECT_THAT(findings(), HasSubstr("R0512_other_service.robdef(3,8): error: R0512 [V03] "));
}

TEST_F(ReadTest, TwoFilesOfOneServiceAreReported) {
  const std::string a = write("a.robdef", "service same\n");
  const std::string b = write("b.robdef", "service same\n");
  EXPECT_THAT(services(read_files({a, b})), ElementsAre("same"));
  EXPECT_THAT(findings(), HasSubstr("b.robdef(1,9): error: R0511 "));
}

TEST_F(ReadTest, MistakesInImportsAreReportedInTheirFile) {
  const std::string input = write("a.robdef", "service a\nimport b\n");
  write("b.robdef", "service b\nmodule x\n");
  read_files({input});
  EXPECT_THAT(findings(), HasSubstr("b.robdef(2,1): error: R0107 "));
}

TEST_F(ReadTest, TextsInMemoryImportEachOtherAndNothingElse) {
  write("c.robdef", "service c\n");
  const Program program = read_texts(
      {{"a", "service a\nimport b\nimport c\n", false}, {"b", "service b\nimport a\n", true}},
      sources_, report_);
  EXPECT_THAT(services(program), ElementsAre("a", "(b)"));
  EXPECT_EQ(findings(), "");
}

TEST_F(ReadTest, ATextWithoutANameIsStillThere) {
  EXPECT_THAT(services(read_texts({{"a", "# nothing\n", false}}, sources_, report_)),
              ElementsAre("?"));
}

TEST(SearchPath, IsTheFoldersAndThenTheVariable) {
  EXPECT_THAT(make_search_path({"a", "b"}, "c:d;e").folders, ElementsAre("a", "b", "c", "d", "e"));
  EXPECT_THAT(make_search_path({}, ":;c::").folders, ElementsAre("c"));
  EXPECT_THAT(make_search_path({}, "").folders, IsEmpty());
  EXPECT_THAT(make_search_path({}, R"(C:\a;D:\b)", ";").folders, ElementsAre(R"(C:\a)", R"(D:\b)"));
}

TEST_F(ReadTest, AFolderMayHaveAColonInItsName) {
  fs::create_directories(folder_ / "v1:2:3");
  const std::string whole = (folder_ / "v1:2:3").string();
  EXPECT_THAT(make_search_path({}, "a:" + whole + ":c;" + whole).folders,
              ElementsAre("a", whole, "c", whole));
  EXPECT_THAT(make_search_path({}, (folder_ / "v2:3").string()).folders,
              ElementsAre((folder_ / "v2").string(), "3"))
      << "no folder of that name is there";
  EXPECT_THAT(make_search_path({whole}, "").folders, ElementsAre(whole));
}

}  // namespace
}  // namespace robdef::ast
