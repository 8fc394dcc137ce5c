// SPDX-License-Identifier: Apache-2.0
#include "compiler/output/manifest.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <fstream>

namespace robdef {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;

class ManifestTest : public testing::Test {
 protected:
  ManifestTest() {
    std::string pattern = (fs::temp_directory_path() / "robdef-manifest-XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  ~ManifestTest() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }

  fs::path folder_;
};

const auto nothing = [](const std::string&) { return false; };

TEST_F(ManifestTest, IsReadAsItIsWritten) {
  FileSet files;
  files.add("a/b c.txt", "one");
  files.add("d.txt", "two");
  files.add_draft("mine.txt", "three");
  const Manifest manifest(files);
  write("m", manifest.text("cpp"));
  const Manifest again = Manifest::read(folder_ / "m");
  EXPECT_EQ(again.text("cpp"), manifest.text("cpp"));
  EXPECT_TRUE(again.contains("a/b c.txt"));
  EXPECT_FALSE(again.contains("mine.txt")) << "the user's";
}

TEST_F(ManifestTest, TellsWhatIsNoLongerMade) {
  FileSet before;
  before.add("a", "1");
  before.add("b", "2");
  before.add("c", "3");
  FileSet now;
  now.add("b", "other");
  const Manifest old(before);
  EXPECT_THAT(Manifest(now).stale(old, nothing), ElementsAre("a", "c"));
  EXPECT_THAT(Manifest(now).stale(old, [](const std::string& path) { return path == "c"; }),
              ElementsAre("a"));
}

TEST_F(ManifestTest, TellsEditedFilesFromOthers) {
  FileSet files;
  files.add("sub/a", "1");
  files.add("b", "2");
  files.add("gone", "3");
  ASSERT_EQ(files.write(folder_).failure, "");
  const Manifest manifest(files);
  write("b", "edited");
  fs::remove(folder_ / "gone");
  EXPECT_TRUE(manifest.is_unedited(folder_, "sub/a"));
  EXPECT_FALSE(manifest.is_unedited(folder_, "b"));
  EXPECT_FALSE(manifest.is_unedited(folder_, "gone"));
}

TEST_F(ManifestTest, OfSomebodyElseLeadsNowhereOutside) {
  write("outside/victim", "1");
  write("in/x", "");
  fs::create_directory_symlink(folder_ / "outside", folder_ / "in/link");
  FileSet files;
  files.add("victim", "1");
  std::string text = Manifest(files).text("cpp");
  const std::string hash = text.substr(text.find("\nversion 1\n") + 11, 16);
  text += hash + " ../outside/victim\n" + hash + " " + (folder_ / "outside/victim").string() +
          "\n" + hash + " link/victim\n" + hash + " ./victim\n" + hash + " \nshort\n";
  write("in/m", text);
  const Manifest manifest = Manifest::read(folder_ / "in/m");
  EXPECT_FALSE(manifest.contains("../outside/victim"));
  EXPECT_FALSE(manifest.contains((folder_ / "outside/victim").string()));
  EXPECT_FALSE(manifest.contains("./victim"));
  ASSERT_TRUE(manifest.contains("link/victim"));
  EXPECT_FALSE(manifest.is_unedited(folder_ / "in", "link/victim"));
}

TEST_F(ManifestTest, OfALaterVersionIsEmpty) {
  write("m", "version 2\n0000000000000000 a\n");
  EXPECT_FALSE(Manifest::read(folder_ / "m").contains("a"));
  EXPECT_FALSE(Manifest::read(folder_ / "nowhere").contains("a"));
}

TEST_F(ManifestTest, FoldersThatAreEmptyGoToo) {
  write("a/b/c", "1");
  write("a/d", "1");
  EXPECT_TRUE(remove_output(folder_, "a/b/c"));
  EXPECT_FALSE(fs::exists(folder_ / "a/b"));
  EXPECT_TRUE(fs::exists(folder_ / "a/d"));
}

}  // namespace
}  // namespace robdef
