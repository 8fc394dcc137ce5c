// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/directories.hpp"
#include "runtime/cpp/src/discovery/local_nodes.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::discovery {
namespace {

namespace fs = std::filesystem;
using channel::LockedFile;

const std::string id_text = "3d637936-35be-4266-bdc8-ab45d55312d5";

/// The folders of a user, made up.
class LocalNodes : public ::testing::Test {
 protected:
  LocalNodes() {
    std::string pattern = (fs::temp_directory_path() / "rr-local-XXXXXX").string();
    home_ = mkdtemp(pattern.data());
    setenv("ROBOTRACONTEUR_SYSTEM_RUN_DIR", (home_ / "system").c_str(), 1);
    setenv("ROBOTRACONTEUR_USER_RUN_DIR", (home_ / "system/root").c_str(), 1);
  }
  ~LocalNodes() override {
    unsetenv("ROBOTRACONTEUR_SYSTEM_RUN_DIR");
    unsetenv("ROBOTRACONTEUR_USER_RUN_DIR");
    fs::remove_all(home_);
  }

  /// A node's files below a base, held while the result lives.
  static std::vector<std::unique_ptr<LockedFile>> serve(const fs::path& base,
                                                        const std::string& user) {
    const std::string info = "ServiceStateNonce: EwiWP1HJx4yoBeKi\nnodeid: {" + id_text +
                             "}\nnodename: my.node-1\npid: 1\nsocket: /x.sock\nusername: " + user +
                             "\n";
    std::vector<std::unique_ptr<LockedFile>> files;
    files.push_back(std::make_unique<LockedFile>(base / "by-nodeid" / (id_text + ".info"), "id"));
    files.push_back(std::make_unique<LockedFile>(base / "by-nodename" / "my.node-1.info", "name"));
    for (const auto& file : files) file->write(info);
    return files;
  }
  [[nodiscard]] fs::path own() const { return home_ / "system/root/transport/local"; }
  [[nodiscard]] fs::path others(const std::string& user) const {
    return home_ / "system/transport/local" / user;
  }

  fs::path home_;
};

TEST_F(LocalNodes, AreFoundByTheirFiles) {
  EXPECT_TRUE(find_local_nodes().empty());
  const auto files = serve(own(), "somebody");
  const auto nodes = find_local_nodes();
  ASSERT_EQ(nodes.size(), 1U);
  EXPECT_EQ(nodes[0].node.text(), id_text);
  EXPECT_EQ(nodes[0].name, "my.node-1");
  EXPECT_EQ(nodes[0].nonce, "EwiWP1HJx4yoBeKi");
  EXPECT_EQ(nodes[0].url, "rr+local:///?nodeid=" + id_text + "&service=RobotRaconteurServiceIndex");
}

TEST_F(LocalNodes, OfOthersAreNamedByTheirUser) {
  const auto files = serve(others("alice"), "alice");
  const auto wrong = serve(others("mallory"), "alice");
  const auto nodes = find_local_nodes();
  ASSERT_EQ(nodes.size(), 1U);
  EXPECT_EQ(nodes[0].url, "rr+local://alice@localhost/?nodeid=" + id_text +
                              "&service=RobotRaconteurServiceIndex");
}

TEST_F(LocalNodes, ThatHaveEndedAreLeftOut) {
  auto files = serve(own(), "somebody");
  EXPECT_EQ(find_local_nodes().size(), 1U);
  EXPECT_EQ(find_local_nodes().size(), 1U);  // looking has not let go of the lock
  files.clear();
  EXPECT_TRUE(find_local_nodes().empty());
}

TEST_F(LocalNodes, FilesThatAreNoneAreNotHeeded) {
  fs::create_directories(own() / "by-nodeid" / "folder.info");
  ASSERT_EQ(mkfifo((own() / "by-nodeid" / "pipe.info").c_str(), 0600), 0);
  LockedFile noise(own() / "by-nodeid" / "noise.info", "noise");
  noise.write(std::string(200'000, 'x') + "\nnodeid: no\n");
  EXPECT_TRUE(find_local_nodes().empty());
}

TEST_F(LocalNodes, AFileIsHeldByOne) {
  std::optional<LockedFile> first(std::in_place, home_ / "a" / "b.pid", "b");
  EXPECT_TRUE(LockedFile::is_held(home_ / "a" / "b.pid"));
  EXPECT_EQ(rr::testing::error_of([&] { LockedFile second(home_ / "a" / "b.pid", "b"); }).code(),
            ErrorCode::invalid_operation);
  first->write("12345");
  first->write("678");
  EXPECT_EQ(fs::file_size(home_ / "a" / "b.pid"), 3U);
  first.reset();
  EXPECT_FALSE(LockedFile::is_held(home_ / "a" / "b.pid"));
}

}  // namespace
}  // namespace rr::discovery
