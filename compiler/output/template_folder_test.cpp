// SPDX-License-Identifier: Apache-2.0
#include "compiler/output/template_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace robdef {
namespace {

namespace fs = std::filesystem;

class FolderTest : public testing::Test {
 protected:
  FolderTest()
      : folder_(fs::temp_directory_path() /
                (std::string("robdef_folder_") +
                 testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~FolderTest() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }

  fs::path folder_;
};

TEST_F(FolderTest, ReadsTemplatesAndRules) {
  write("a.txt.mustache", "{{name}}");
  write("readme.md", "not a template");
  write("outputs.txt", "# comment\n\ndefinition a.txt.mustache {{path}}.txt\n");
  const TemplateFolder read = TemplateFolder::from_disk(folder_);
  ASSERT_EQ(read.sources.size(), 1U);
  EXPECT_EQ(read.sources.at("a.txt.mustache"), "{{name}}");
  ASSERT_EQ(read.rules.size(), 1U);
  EXPECT_EQ(read.rules[0].subject, "definition");
  EXPECT_EQ(read.rules[0].name, "a.txt.mustache");
  EXPECT_EQ(read.rules[0].path, "{{path}}.txt");
  EXPECT_EQ(read.rules[0].line, 3U);
}

TEST_F(FolderTest, RefusesARuleThatHasNotThreeWords) {
  write("outputs.txt", "definition a\n");
  EXPECT_THROW(TemplateFolder::from_disk(folder_), TemplateError);
  write("outputs.txt", "definition a b c\n");
  EXPECT_THROW(TemplateFolder::from_disk(folder_), TemplateError);
}

TEST_F(FolderTest, RefusesAFolderThatIsMissingOrHoldsNoTemplate) {
  EXPECT_THROW(TemplateFolder::from_disk(folder_), TemplateError);
  EXPECT_THROW(TemplateFolder::from_disk(folder_ / "none"), TemplateError);
}

TEST_F(FolderTest, ReplacesTemplatesOfTheSameNameAndAllRules) {
  const TemplateFolder below = TemplateFolder::from_sources(
      {{"a.mustache", "1"}, {"b.mustache", "2"}, {"outputs.txt", "all a.mustache a.txt"}});
  const TemplateFolder partial =
      below.overlaid_with(TemplateFolder::from_sources({{"b.mustache", "3"}}));
  EXPECT_EQ(partial.sources.at("a.mustache"), "1");
  EXPECT_EQ(partial.sources.at("b.mustache"), "3");
  ASSERT_EQ(partial.rules.size(), 1U);

  const TemplateFolder whole = below.overlaid_with(
      TemplateFolder::from_sources({{"outputs.txt", "all b.mustache b.txt\n"}}));
  ASSERT_EQ(whole.rules.size(), 1U);
  EXPECT_EQ(whole.rules[0].path, "b.txt");
}

}  // namespace
}  // namespace robdef
