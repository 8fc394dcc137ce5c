// SPDX-License-Identifier: Apache-2.0
#include "compiler/output/pending_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

namespace robdef {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class PendingFilesTest : public testing::Test {
 protected:
  PendingFilesTest()
      : folder_(fs::temp_directory_path() /
                (std::string("robdef_pending_") +
                 testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~PendingFilesTest() override { fs::remove_all(folder_); }

  void put(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  [[nodiscard]] std::string read(const std::string& name) const {
    std::ifstream in(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  [[nodiscard]] std::size_t entries() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
};

TEST_F(PendingFilesTest, NothingIsThereBeforeAllIs) {
  put("a", "old");
  PendingFiles files;
  ASSERT_EQ(files.write(folder_ / "a", "new"), "");
  ASSERT_EQ(files.write(folder_ / "deep/b", "new"), "");
  EXPECT_EQ(read("a"), "old");
  ASSERT_EQ(files.move_all(), "");
  EXPECT_EQ(read("a"), "new");
  EXPECT_EQ(read("deep/b"), "new");
  EXPECT_EQ(entries(), 2U) << "no file is left beside";
}

TEST_F(PendingFilesTest, OneThatCannotBeRenamedGivesTheOthersBack) {
  put("a", "old");
  PendingFiles files;
  ASSERT_EQ(files.write(folder_ / "a", "new"), "");
  ASSERT_EQ(files.write(folder_ / "b", "new"), "");
  ASSERT_EQ(files.write(folder_ / "c", "new"), "");
  fs::create_directories(folder_ / "c/full");  // comes in between
  EXPECT_THAT(files.move_all(), HasSubstr("c: "));
  EXPECT_EQ(read("a"), "old");
  EXPECT_FALSE(fs::exists(folder_ / "b"));
}

TEST_F(PendingFilesTest, WhatIsGivenUpIsRemoved) {
  put("a", "old");
  {
    PendingFiles files;
    ASSERT_EQ(files.write(folder_ / "a", "new"), "");
  }
  EXPECT_EQ(read("a"), "old");
  EXPECT_EQ(entries(), 1U);
}

TEST_F(PendingFilesTest, AFileKeepsItsPermissions) {
  put("a", "old");
  fs::permissions(folder_ / "a", fs::perms::owner_read | fs::perms::owner_write);
  PendingFiles files;
  ASSERT_EQ(files.write(folder_ / "a", "new"), "");
  ASSERT_EQ(files.move_all(), "");
  EXPECT_EQ(fs::status(folder_ / "a").permissions(),
            fs::perms::owner_read | fs::perms::owner_write);
}

}  // namespace
}  // namespace robdef
