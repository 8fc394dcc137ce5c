// SPDX-License-Identifier: Apache-2.0
// Project files, what they mean, and the findings of wrong ones.
#include "compiler/project/project.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "compiler/diagnostics/golden_corpus.hpp"
#include "compiler/diagnostics/render.hpp"

namespace robdef::project {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

const std::vector<std::string_view> languages{"cpp", "csharp", "matlab"};

class ProjectFile : public testing::Test {
 protected:
  ProjectFile() {
    std::string pattern = (fs::temp_directory_path() / "robdef-project-XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
    for (const char* file : {"b.robdef", "a.robdef", "deep/c.robdef"}) write(file, "service x\n");
  }
  ~ProjectFile() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  Project read(const std::string& text) {
    write("robdef.toml", text);
    return project::read((folder_ / "robdef.toml").string(), languages, sources_, report_);
  }
  [[nodiscard]] std::string findings() const { return render(report_, sources_, Format::line); }
  [[nodiscard]] std::string below(const std::string& name) const {
    return (folder_ / name).string();
  }

  fs::path folder_;
  Sources sources_;
  Report report_;
};

TEST_F(ProjectFile, SaysWhatIsReadAndWhatIsMade) {
  const Project project = read(
      "inputs = [\"b.robdef\", \"*.robdef\", \"./deep/../b.robdef\"]\n"
      "import-path = [\"shared\", \"/usr/share/robdef\"]\nstrict = true\n"
      "levels = { unused = \"deny\", R0610 = \"allow\" }\n"
      "[csharp]\noutput = \"out/cs/\"\ntemplates = \"mine\"\n"
      "[csharp.rename]\n\"example.Arm.move\" = \"go\"\n\"example.Arm\" = \"Limb\"\n"
      "[cpp]\noutput = \".\"\n");
  EXPECT_EQ(findings(), "");
  EXPECT_TRUE(project.has_inputs);
  EXPECT_THAT(project.inputs, ElementsAre(below("b.robdef"), below("a.robdef")));
  EXPECT_THAT(project.import_folders, ElementsAre(below("shared"), "/usr/share/robdef"));
  EXPECT_TRUE(project.is_strict);
  EXPECT_EQ(project.levels.find(Code::R0611), Level::deny);
  EXPECT_EQ(project.levels.find(Code::R0610), Level::allow);
  ASSERT_EQ(project.languages.size(), 2U);
  EXPECT_EQ(project.languages[0].name, "cpp") << "in the order of the languages";
  const Language& csharp = *project.find("csharp");
  EXPECT_EQ(csharp.output_folder, below("out/cs"));
  EXPECT_EQ(csharp.template_folder, below("mine"));
  ASSERT_EQ(csharp.renames.size(), 2U);
  EXPECT_EQ(csharp.renames[0].path, "example.Arm.move");
  EXPECT_EQ(csharp.renames[0].name, "go");
  const Source& source = sources_[SourceId{0}];
  const Span place = *csharp.renames[0].place;
  EXPECT_EQ(source.text().substr(place.begin, place.end - place.begin), "\"example.Arm.move\"");
  EXPECT_EQ(project.find("matlab"), nullptr);
}

TEST_F(ProjectFile, MayBeEmpty) {
  const Project project = read("\xEF\xBB\xBF# nothing yet\r\n");
  EXPECT_EQ(findings(), "");
  EXPECT_FALSE(project.has_inputs);
  EXPECT_TRUE(project.languages.empty());
}

TEST_F(ProjectFile, ThatCannotBeReadIsAnError) {
  project::read(below("nowhere.toml"), languages, sources_, report_);
  EXPECT_EQ(findings(), below("nowhere.toml") + "(1,1): error: R0510 `" + below("nowhere.toml") +
                            "` cannot be read: No such file or directory\n");
}

TEST_F(ProjectFile, OfAMegabyteOfBracketsIsRefused) {
  read("inputs = " + std::string(1'000'000, '['));
  EXPECT_TRUE(report_.has_errors());
}

TEST_F(ProjectFile, IsFoundInTheFolderOrTheNearestOneAbove) {
  const fs::path before = fs::current_path();
  write("robdef.toml", "");
  write("deep/robdef.toml/is_a_folder", "");
  fs::current_path(folder_);
  EXPECT_EQ(find_file(), "robdef.toml");
  fs::create_directories("deep/er");
  fs::current_path("deep/er");
  EXPECT_EQ(find_file(), "../../robdef.toml");
  fs::current_path(before);
}

std::string shown(const fs::path& file) {
  Sources sources;
  Report report;
  const fs::path before = fs::current_path();
  // So that the goldens have no path of this machine.
  fs::current_path(file.parent_path());
  project::read(file.filename().string(), languages, sources, report);
  fs::current_path(before);
  return render(report, sources, Format::text);
}

TEST(ProjectReject, EachFileGivesWhatStandsBesideIt) {
  const GoldenCorpus corpus(ROBDEF_PROJECT_REJECT_DIR, ".toml");
  ASSERT_FALSE(corpus.inputs().empty());
  for (const fs::path& input : corpus.inputs()) {
    EXPECT_EQ(corpus.difference(input, ".stderr", shown(input)), "");
  }
}

TEST(ProjectReject, EachCodeOfProjectFilesHasAFile) {
  const GoldenCorpus corpus(ROBDEF_PROJECT_REJECT_DIR, ".toml");
  for (const CodeEntry& entry : code_entries()) {
    // R0805 is found with the definitions; driver_test has it.
    if (!entry.name.starts_with("R08") || entry.name == "R0805") continue;
    EXPECT_TRUE(std::ranges::any_of(corpus.inputs(), [&](const fs::path& input) {
      return input.filename().string().starts_with(entry.name) &&
             shown(input).find(entry.name) != std::string::npos;
    })) << entry.name;
  }
}

}  // namespace
}  // namespace robdef::project
