// SPDX-License-Identifier: Apache-2.0
// Files that hold secrets, that programs write logs to, and that nodes find each other by.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "rr/error.hpp"
#include "rr/url.hpp"
#include "runtime/cpp/src/channel/directories.hpp"
#include "runtime/cpp/src/channel/node_files.hpp"
#include "runtime/cpp/src/channel/private_files.hpp"
#include "runtime/cpp/src/channel/rotating_file.hpp"
#include "runtime/cpp/src/channel/run_directories.hpp"
#include "runtime/cpp/src/channel/testing/temporary_folder.hpp"

namespace rr::channel {
namespace {

namespace fs = std::filesystem;
using rr::testing::TemporaryFolder;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

template <class Run>
ErrorCode failure(const Run& run) {
  try {
    run();
  } catch (const Error& error) {
    return error.code();
  }
  return ErrorCode::none;
}

TEST(PrivateFiles, AreReplacedWholeAndForTheirUserAlone) {
  const TemporaryFolder folder;
  const std::string path = folder.path("key");
  folder.write("other", "kept");
  fs::create_symlink(folder.path("other"), path);
  replace_file(path, std::string_view("one"), secret_file);
  EXPECT_EQ(folder.text("key"), "one");
  EXPECT_EQ(folder.text("other"), "kept") << "a link is not followed";
  EXPECT_EQ(fs::status(path).permissions(), fs::perms(0600));
  replace_file(path, std::string_view("two"), public_file);
  EXPECT_EQ(folder.text("key"), "two");
  EXPECT_EQ(fs::status(path).permissions(), fs::perms(0644));
  EXPECT_FALSE(fs::exists(path + ".new"));
  EXPECT_EQ(
      failure([&] { replace_file(folder.path("none/key"), std::string_view("x"), secret_file); }),
      ErrorCode::invalid_configuration);
}

TEST(PrivateFiles, AreCreatedOnce) {
  const TemporaryFolder folder;
  create_file(folder.path("key"), std::string_view("one"), secret_file);
  EXPECT_EQ(failure([&] { create_file(folder.path("key"), std::string_view("two"), secret_file); }),
            ErrorCode::invalid_operation);
  EXPECT_EQ(folder.text("key"), "one");
}

TEST(PrivateFiles, TheirFolderIsTheUsersAlone) {
  const TemporaryFolder folder;
  const std::string path = folder.path("a/b");
  make_private_folder(path);
  EXPECT_EQ(fs::status(path).permissions(), fs::perms(0700));
  make_private_folder(path);  // is there
  fs::permissions(path, fs::perms(0777));
  EXPECT_EQ(failure([&] { make_private_folder(path); }), ErrorCode::invalid_configuration);
  folder.write("file", "");
  EXPECT_EQ(failure([&] { make_private_folder(folder.path("file")); }),
            ErrorCode::invalid_configuration);
}

TEST(RotatingFile, KeepsSoManyOfSoManyBytes) {
  const TemporaryFolder folder;
  RotatingFile file(folder.path("log"), 10, 2);
  for (const char* line : {"11111\n", "2222\n", "33333\n", "44444\n"}) file.write(line);
  EXPECT_EQ(folder.text("log"), "44444\n");
  EXPECT_EQ(folder.text("log.1"), "33333\n");
  EXPECT_EQ(folder.text("log.2"), "2222\n");
  EXPECT_FALSE(fs::exists(folder.path("log.3")));
  EXPECT_EQ(fs::status(folder.path("log")).permissions(), fs::perms(0600));
}

TEST(RotatingFile, GoesOnWithOneThatIsThere) {
  const TemporaryFolder folder;
  RotatingFile(folder.path("log"), 10, 0).write("12345\n");
  RotatingFile file(folder.path("log"), 10, 0);
  file.write("678\n");
  EXPECT_EQ(folder.text("log"), "12345\n678\n");
  file.write("9\n");
  EXPECT_EQ(folder.text("log"), "9\n") << "none is kept";
  fs::create_symlink(folder.path("log"), folder.path("link"));
  EXPECT_EQ(failure([&] { RotatingFile(folder.path("link"), 10, 0); }),
            ErrorCode::invalid_configuration);
}

TEST(LockedFile, IsHeldByOne) {
  const TemporaryFolder folder;
  const std::string path = folder.path("a/file");
  EXPECT_FALSE(LockedFile::is_held(path));
  {
    const LockedFile file(path, "the name");
    EXPECT_TRUE(LockedFile::is_held(path));
    file.write("a longer text");
    file.write("text");
    EXPECT_EQ(folder.text("a/file"), "text");
    EXPECT_EQ(failure([&] { const LockedFile other(path, "the name"); }),
              ErrorCode::invalid_operation);
  }
  EXPECT_FALSE(LockedFile::is_held(path));
  EXPECT_EQ(folder.text("a/file"), "text");
}

TEST(InfoFile, IsLinesOfKeysAndValues) {
  const TemporaryFolder folder;
  folder.write("info", "pid: 12\n nodename : a b \nnothing\npid: 13\nempty:");
  EXPECT_THAT(read_info_file(folder.path("info")),
              UnorderedElementsAre(Pair("pid", "12"), Pair("nodename", "a b"), Pair("empty", "")));
  EXPECT_TRUE(read_info_file(folder.path("none")).empty());
  folder.write("large", std::string(64 * 1024 + 1, 'x') + "\nkey: 1\n");
  EXPECT_TRUE(read_info_file(folder.path("large")).empty());
  fs::create_symlink(folder.path("info"), folder.path("link"));
  EXPECT_TRUE(read_info_file(folder.path("link")).empty());
}

TEST(RunDirectories, NamesOfUsersAreSafeInPaths) {
  for (const char* name : {"root", "a1", "A_b-c"}) EXPECT_TRUE(is_user_name(name)) << name;
  for (const char* name : {"", "1a", "_a", "a/b", "a.b", ".."}) {
    EXPECT_FALSE(is_user_name(name)) << name;
  }
}

// Folders of a run directory of the test.
class RunDirectoryTest : public ::testing::Test {
 protected:
  const TemporaryFolder run_;
  const LocalOptions options_{.user_run_dir = run_.path("user"),
                              .system_run_dir = run_.path("system")};
  const std::string own_ = own_user_name();
};

TEST_F(RunDirectoryTest, AreThoseOfTheOptions) {
  EXPECT_EQ(user_run_directory(options_), run_.path("user"));
  EXPECT_EQ(system_run_directory(options_), run_.path("system"));
  const NodeFolder mine = private_folder(options_);
  EXPECT_EQ(mine.base, run_.path("user/transport/local"));
  EXPECT_EQ(mine.sockets, run_.path("user/socket"));
  EXPECT_FALSE(mine.is_public);
  const NodeFolder shared = public_folder(options_, own_);
  EXPECT_EQ(shared.base, run_.path("system/transport/local/" + own_));
  EXPECT_TRUE(shared.is_public);
}

TEST_F(RunDirectoryTest, AHostNamesTheUser) {
  const auto bases = [&](std::string_view host) {
    std::vector<std::string> found;
    for (const NodeFolder& folder : folders_for_host(options_, host)) found.push_back(folder.base);
    return found;
  };
  const std::string mine = private_folder(options_).base;
  const std::string shared = public_folder(options_, own_).base;
  const std::string root = public_folder(options_, "root").base;
  EXPECT_THAT(bases("localhost"), ::testing::ElementsAre(mine, shared, root));
  EXPECT_EQ(bases(""), bases("localhost"));
  EXPECT_THAT(bases(own_ + "@localhost"), ::testing::ElementsAre(mine, shared));
  EXPECT_THAT(bases("nobody@localhost"),
              ::testing::ElementsAre(public_folder(options_, "nobody").base));
  EXPECT_EQ(failure([&] { bases("elsewhere"); }), ErrorCode::invalid_argument);
  EXPECT_EQ(failure([&] { bases("../x@localhost"); }), ErrorCode::invalid_argument);
}

TEST_F(RunDirectoryTest, APrivateFolderIsMadeAndAPublicOneIsNot) {
  const NodeFolder mine = private_folder(options_);
  make_folder(mine);
  EXPECT_EQ(fs::status(mine.sockets).permissions(), fs::perms(0700));
  EXPECT_TRUE(fs::is_directory(mine.base + "/by-nodeid"));
  EXPECT_TRUE(fs::is_directory(mine.base + "/by-nodename"));
  EXPECT_EQ(failure([&] { make_folder(public_folder(options_, own_)); }),
            ErrorCode::system_resource_error);
}

TEST_F(RunDirectoryTest, ANodeIsFoundByItsIdAndName) {
  const NodeFolder folder = private_folder(options_);
  make_folder(folder);
  const NodeId id = NodeId::random();
  const std::string socket = folder.sockets + "/abc.sock";
  const auto found = [&](const std::string& query) {
    const auto sockets = find_sockets(options_, Url::parse("rr+local:///?" + query + "&service=s"));
    return sockets.empty() ? std::string() : sockets.front().path;
  };
  {
    NodeFiles files(folder, id, "board", socket, "first");
    EXPECT_EQ(found("nodename=board"), socket);
    EXPECT_EQ(found("nodeid=" + id.text()), socket);
    EXPECT_EQ(found("nodeid=" + id.text() + "&nodename=board"), socket);
    EXPECT_EQ(found("nodeid=" + id.text() + "&nodename=other"), "");
    EXPECT_EQ(found("nodename=other"), "");
    const std::string info = folder.base + "/by-nodename/board.info";
    EXPECT_EQ(read_info_file(info)["ServiceStateNonce"], "first");
    files.set_nonce("second");
    EXPECT_EQ(read_info_file(info)["ServiceStateNonce"], "second");
    EXPECT_EQ(failure([&] { const NodeFiles twin(folder, id, "", socket, ""); }),
              ErrorCode::invalid_operation);
  }
  EXPECT_EQ(found("nodename=board"), "");
  EXPECT_EQ(failure([&] { find_sockets(options_, Url::parse("rr+local:///?service=s")); }),
            ErrorCode::invalid_argument);
}

TEST_F(RunDirectoryTest, SocketsOfNodesThatLiveNoMoreAreRemoved) {
  const NodeFolder folder = private_folder(options_);
  make_folder(folder);
  const std::string path = folder.sockets + "/dead.sock";
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  ASSERT_LT(path.size(), sizeof address.sun_path);
  path.copy(address.sun_path, path.size());
  ASSERT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  ::close(socket);
  const std::string name = "transport/local/by-nodeid/x.info";
  run_.write("user/" + name, "socket: " + run_.path("elsewhere.sock") + "\n");
  clean_up(folder);
  EXPECT_TRUE(fs::exists(path));
  run_.write("user/" + name, "socket: " + path + "\n");
  {
    const LockedFile held(run_.path("user/" + name), "it");
    held.write("socket: " + path + "\n");
    clean_up(folder);
    EXPECT_TRUE(fs::exists(path)) << "its node lives";
  }
  clean_up(folder);
  EXPECT_FALSE(fs::exists(path));
}

}  // namespace
}  // namespace rr::channel
