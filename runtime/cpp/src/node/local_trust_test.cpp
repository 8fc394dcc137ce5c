// SPDX-License-Identifier: Apache-2.0
// Local sockets that other users have a hand in. What needs two users needs root.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <functional>
#include <mutex>
#include <sstream>
#include <string>

#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/replay/stream.hpp"

namespace rr::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr uid_t other_user = 61'234;
constexpr uid_t third_user = 61'235;

mode_t mode_of(const fs::path& path) {
  struct stat found {};
  return stat(path.c_str(), &found) == 0 ? found.st_mode & 07777U : 0;
}

class LocalTrust : public ::testing::Test {
 protected:
  LocalTrust() {
    std::string pattern = (fs::temp_directory_path() / "rr-trust-XXXXXX").string();
    home = mkdtemp(pattern.data());
    fs::permissions(home, fs::perms(0755));
    run = home / "run";
  }
  ~LocalTrust() override { fs::remove_all(home); }

  NodeOptions options(const std::string& name = {}) const {
    return {.name = name,
            .local = {.user_run_dir = run.string(), .system_run_dir = (home / "system").string()}};
  }
  std::string refusal(const std::string& url) const {
    Node node(options());
    return error_of([&] { node.listen(url); }).message();
  }
  fs::path home;
  fs::path run;
};

TEST_F(LocalTrust, PrivateFoldersAreMadeForTheirUserAlone) {
  const mode_t before = umask(0);
  Node node(options("private.node"));
  node.listen("rr+local://");
  umask(before);
  for (const fs::path& part : {run, run / "socket", run / "transport", run / "transport/local",
                               run / "transport/local/by-nodeid"}) {
    EXPECT_EQ(mode_of(part), 0700U) << part;
  }
}

TEST_F(LocalTrust, FoldersThatEverybodyMayWriteToAreRefused) {
  fs::create_directories(run / "socket");
  fs::permissions(run / "socket", fs::perms(0777));
  EXPECT_THAT(refusal("rr+local://"), HasSubstr("everybody may write to it"));
  fs::permissions(run / "socket", fs::perms(0700));
  fs::permissions(run, fs::perms(0777));  // above it counts as well
  EXPECT_THAT(refusal("rr+local://"), HasSubstr("everybody may write to it"));
  Node client(options());
  EXPECT_THAT(error_of([&] {
                client.connect<CounterStub>("rr+local:///?nodename=any.node&service=counter");
              }).message(),
              HasSubstr("everybody may write to it"));
  fs::permissions(run, fs::perms(01777));  // but not rename what is in it
  EXPECT_EQ(refusal("rr+local://"), "");
}

TEST_F(LocalTrust, NothingButADeadSocketIsReplaced) {
  const std::string path = (home / "own.sock").string();
  const std::string url = "rr+local://" + path;
  std::ofstream(path) << "precious";
  EXPECT_THAT(refusal(url), HasSubstr("cannot listen at"));
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  EXPECT_EQ(text.str(), "precious");
  fs::remove(path);
  fs::create_directory(path);
  EXPECT_THAT(refusal(url), HasSubstr("cannot listen at"));
  EXPECT_TRUE(fs::is_directory(path));
  fs::remove(path);
  std::ofstream(home / "target") << "precious";
  fs::create_symlink(home / "target", path);
  EXPECT_THAT(refusal(url), HasSubstr("cannot listen at"));
  EXPECT_TRUE(fs::is_symlink(path));
  EXPECT_TRUE(fs::exists(home / "target"));
}

TEST_F(LocalTrust, WhatHasTakenItsPlaceIsLeftByANodeThatEnds) {
  const std::string path = (home / "own.sock").string();
  Node node(options());
  node.listen("rr+local://" + path);
  fs::remove(path);
  std::ofstream(path) << "another's";
  node.shutdown();
  EXPECT_TRUE(fs::exists(path));
}

/// With root: what another user does happens in a process of his.
class LocalUsers : public LocalTrust {
 protected:
  void SetUp() override {
    if (geteuid() != 0) GTEST_SKIP() << "needs root";
  }
  // Runs something as another user; whether it says that all is well.
  static bool as(uid_t user, const std::function<bool()>& what) {
    const pid_t child = fork();
    if (child == 0) {
      const bool is_other = setgid(user) == 0 && setuid(user) == 0;
      bool is_well = false;
      try {
        is_well = is_other && what();
      } catch (const std::exception&) {
        is_well = false;
      }
      _exit(is_well ? 0 : 1);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }
  static void give(const fs::path& path, uid_t user) {
    ASSERT_EQ(chown(path.c_str(), user, user), 0);
  }
};

TEST_F(LocalUsers, AFolderOfAnotherUserIsRefusedByBothSides) {
  fs::create_directories(run / "transport/local/by-nodename");
  fs::create_directories(run / "socket");
  give(run, other_user);
  std::ofstream(run / "transport/local/by-nodename/any.node.info")
      << "nodename: any.node\nsocket: " << (run / "socket/x.sock").string() << "\n";
  EXPECT_THAT(refusal("rr+local://"), HasSubstr("belongs to another user"));
  Node client(options());
  EXPECT_THAT(error_of([&] {
                client.connect<CounterStub>("rr+local:///?nodename=any.node&service=counter");
              }).message(),
              HasSubstr("belongs to another user"));
}

TEST_F(LocalUsers, ASocketThatAnotherUserServesIsRefusedBeforeAnythingIsSaid) {
  fs::create_directories(run);
  fs::permissions(run, fs::perms(01777));
  const fs::path path = run / "evil.sock";
  std::array<int, 2> ready{};
  ASSERT_EQ(::pipe(ready.data()), 0);
  const pid_t child = fork();
  if (child == 0) {
    if (setgid(other_user) != 0 || setuid(other_user) != 0) _exit(2);
    replay::Listener listener(path);
    fs::permissions(path, fs::perms(0777));
    if (write(ready[1], "r", 1) != 1) _exit(2);
    auto stream = listener.accept(replay::Milliseconds(10'000));
    replay::Bytes bytes;
    const bool is_silent =
        !stream || stream->receive(bytes, replay::Milliseconds(5'000)) != replay::Arrival::message;
    _exit(is_silent ? 0 : 1);
  }
  char byte = 0;
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  {
    Node client(options());
    EXPECT_THAT(error_of([&] {
                  client.connect<CounterStub>("rr+local://" + path.string() + "?service=counter");
                }).message(),
                HasSubstr("is served by user 61234"));
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 0);
  for (const int end : ready) close(end);
}

TEST_F(LocalUsers, APrivateNodeLetsNoOtherUserIn) {
  fs::create_directories(home / "open");
  const std::string path = (home / "open/own.sock").string();
  std::string logged;
  std::mutex mutex;
  NodeOptions serving = options();
  serving.log = [&](LogLevel, std::string_view text) {
    const std::lock_guard lock(mutex);
    logged += text;
  };
  Node node(serving);
  node.listen("rr+local://" + path);
  fs::permissions(path, fs::perms(0777));  // as a mistake of the administrator would
  EXPECT_TRUE(as(other_user, [&] {
    replay::Stream stream = replay::Stream::connect(fs::path(path));
    replay::Bytes bytes;
    return stream.receive(bytes, replay::Milliseconds(10'000)) == replay::Arrival::closed;
  }));
  EXPECT_TRUE(eventually([&] {
    const std::lock_guard lock(mutex);
    return logged.find("a local connection was refused: it is of user 61234") != std::string::npos;
  }));
}

TEST_F(LocalUsers, APublicNodeLetsThemIn) {
  fs::create_directories(home / "open");
  const std::string path = (home / "open/own.sock").string();
  Node node(options());
  node.listen("rr+local://" + path + "?public=true");
  fs::permissions(path, fs::perms(0777));
  EXPECT_TRUE(as(third_user, [&] {
    replay::Stream stream = replay::Stream::connect(fs::path(path));
    replay::Bytes bytes;
    return stream.receive(bytes, replay::Milliseconds(300)) == replay::Arrival::nothing;
  }));
}

}  // namespace
}  // namespace rr::testing
