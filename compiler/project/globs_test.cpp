// SPDX-License-Identifier: Apache-2.0
#include "compiler/project/globs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace robdef::project {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;

class Globs : public testing::Test {
 protected:
  Globs() {
    std::string pattern = (fs::temp_directory_path() / "robdef-globs-XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
    for (const char* file : {"b.robdef", "a.robdef", "a.txt", "deep/c.robdef", "deep/er/d.robdef",
                             ".hidden/e.robdef", "deep/.f.robdef", "folder.robdef/g"}) {
      fs::create_directories((folder_ / file).parent_path());
      std::ofstream(folder_ / file) << "x";
    }
    fs::create_directory_symlink(folder_, folder_ / "deep/round");
  }
  ~Globs() override { fs::remove_all(folder_); }

  // Relative to the folder.
  [[nodiscard]] std::vector<std::string> matching(const std::string& pattern) const {
    std::vector<std::string> found;
    for (const std::string& file : matching_files((folder_ / pattern).string())) {
      found.push_back(fs::path(file).lexically_relative(folder_).generic_string());
    }
    return found;
  }

  fs::path folder_;
};

TEST_F(Globs, StarsAndQuestionMarksStandForLettersOfOneName) {
  EXPECT_THAT(matching("*.robdef"), ElementsAre("a.robdef", "b.robdef"));
  EXPECT_THAT(matching("?.*"), ElementsAre("a.robdef", "a.txt", "b.robdef"));
  EXPECT_THAT(matching("[b-z].robdef"), ElementsAre("b.robdef"));
  EXPECT_THAT(matching("*/c.robdef"), ElementsAre("deep/c.robdef"));
  EXPECT_THAT(matching("x*"), IsEmpty());
  EXPECT_THAT(matching("nowhere/*"), IsEmpty());
  EXPECT_THAT(matching("[!a].robdef"), ElementsAre("b.robdef"));
  EXPECT_THAT(matching("*.*"), ElementsAre("a.robdef", "a.txt", "b.robdef"));
  EXPECT_THAT(matching("a*t*t"), ElementsAre("a.txt"));
  EXPECT_THAT(matching("a*t*x"), IsEmpty());
  EXPECT_THAT(matching("deep/.*.robdef"), ElementsAre("deep/.f.robdef"));
  EXPECT_THAT(matching("[]b]*"), ElementsAre("b.robdef"));
  EXPECT_THAT(matching("[b.robdef"), IsEmpty());
}

TEST_F(Globs, TwoStarsStandForFoldersOfAnyDepthButNotBehindLinks) {
  EXPECT_THAT(matching("**/*.robdef"),
              ElementsAre("a.robdef", "b.robdef", "deep/c.robdef", "deep/er/d.robdef"));
  EXPECT_THAT(matching("deep/**/d.robdef"), ElementsAre("deep/er/d.robdef"));
  EXPECT_THAT(matching("**/**/d.robdef"), ElementsAre("deep/er/d.robdef")) << "each file once";
}

TEST(GlobPatterns, AreWhatHasAWildcard) {
  EXPECT_TRUE(is_pattern("a/*.robdef"));
  EXPECT_TRUE(is_pattern("a?"));
  EXPECT_TRUE(is_pattern("[ab]"));
  EXPECT_FALSE(is_pattern("a/b.robdef"));
}

}  // namespace
}  // namespace robdef::project
