// SPDX-License-Identifier: Apache-2.0
#include "compiler/output/file_set.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace robdef {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class FileSetTest : public testing::Test {
 protected:
  FileSetTest()
      : folder_(fs::temp_directory_path() /
                (std::string("robdef_files_") +
                 testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::remove_all(folder_);
  }
  ~FileSetTest() override { fs::remove_all(folder_); }

  std::string read(const std::string& path) const {
    std::ifstream in(folder_ / path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  std::size_t files_there() const {
    std::size_t count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
      count += entry.is_regular_file() ? 1 : 0;
    }
    return count;
  }

  fs::path folder_;
};

TEST_F(FileSetTest, WritesAllFilesAndMakesFolders) {
  FileSet files;
  files.add("b/c.hpp", "two\n");
  files.add("a.hpp", "one\r\n");
  const FileSet::Written written = files.write(folder_);
  EXPECT_EQ(written.failure, "");
  EXPECT_THAT(written.changed, ElementsAre("a.hpp", "b/c.hpp"));
  EXPECT_EQ(read("a.hpp"), "one\r\n");
  EXPECT_EQ(read("b/c.hpp"), "two\n");
  EXPECT_EQ(files_there(), 2U);
}

TEST_F(FileSetTest, LeavesUnchangedFilesAlone) {
  FileSet files;
  files.add("a.hpp", "one");
  files.add("b.hpp", "two");
  ASSERT_EQ(files.write(folder_).failure, "");
  const auto long_ago = fs::file_time_type::clock::now() - std::chrono::hours(1);
  fs::last_write_time(folder_ / "a.hpp", long_ago);

  FileSet again;
  again.add("a.hpp", "one");
  again.add("b.hpp", "owt");
  EXPECT_THAT(again.write(folder_).changed, ElementsAre("b.hpp"));
  EXPECT_EQ(fs::last_write_time(folder_ / "a.hpp"), long_ago);
  EXPECT_EQ(read("b.hpp"), "owt");
}

TEST_F(FileSetTest, ChangesNothingWhenOneFileCannotBeWritten) {
  fs::create_directories(folder_ / "z.hpp");  // a folder where a file should be
  std::ofstream(folder_ / "a.hpp") << "old";
  FileSet files;
  files.add("a.hpp", "new");
  files.add("z.hpp", "new");
  const FileSet::Written written = files.write(folder_);
  EXPECT_THAT(written.failure, HasSubstr("z.hpp"));
  EXPECT_THAT(written.changed, IsEmpty());
  EXPECT_EQ(read("a.hpp"), "old");
  EXPECT_EQ(files_there(), 1U);
}

TEST_F(FileSetTest, RefusesTwoFilesOfOneName) {
  FileSet files;
  files.add("a/b.hpp", "");
  EXPECT_THROW(files.add("a/./b.hpp", ""), std::logic_error);
  EXPECT_TRUE(files.contains("a/b.hpp"));
}

TEST_F(FileSetTest, RefusesPathsOutsideTheFolder) {
  FileSet files;
  EXPECT_THROW(files.add("../a.hpp", ""), std::logic_error);
  EXPECT_THROW(files.add("/etc/a.hpp", ""), std::logic_error);
  EXPECT_THROW(files.add("a/", ""), std::logic_error);
  EXPECT_THROW(files.add("", ""), std::logic_error);
}

}  // namespace
}  // namespace robdef
