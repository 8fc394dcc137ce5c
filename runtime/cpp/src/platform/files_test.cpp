// SPDX-License-Identifier: Apache-2.0
// Files, folders and users, as the headers promise it on every system.
#include "runtime/cpp/src/platform/files.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>

#include "runtime/cpp/src/platform/clock.hpp"
#include "runtime/cpp/src/platform/local_socket.hpp"
#include "runtime/cpp/src/platform/trusted_folder.hpp"
#include "runtime/cpp/src/platform/users.hpp"
#include "runtime/cpp/src/platform/waiting.hpp"

namespace rr::platform {
namespace {

namespace fs = std::filesystem;

class FilesTest : public ::testing::Test {
 public:
  FilesTest(const FilesTest&) = delete;
  FilesTest& operator=(const FilesTest&) = delete;

 protected:
  FilesTest() {
    const auto* const test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder = fs::temp_directory_path() / u8"rr-h\u00e9-";
    folder += std::to_string(process_id()) + "-" + test->name();
    fs::create_directories(folder);
  }
  ~FilesTest() override {
    std::error_code error;
    fs::remove_all(folder, error);
  }

  [[nodiscard]] std::string in(const char* name) const { return (folder / name).string(); }
  [[nodiscard]] std::string content(const char* name) const {
    std::ifstream file(folder / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  static std::error_code write_new(const std::string& path, std::string_view text) {
    return write_new_file(path, std::span(text), Access::owner);
  }

  fs::path folder;
};

TEST_F(FilesTest, AreMadeOnceAndReplacedWhole) {
  EXPECT_FALSE(write_new(in("a"), "one\n"));
  EXPECT_EQ(write_new(in("a"), "two"), std::errc::file_exists);
  EXPECT_FALSE(write_new(in("b"), "three"));
  EXPECT_FALSE(rename_file(in("b"), in("a")));
  EXPECT_EQ(content("a"), "three");
  EXPECT_FALSE(fs::exists(folder / "b"));
  EXPECT_FALSE(remove_file(in("a")));
  EXPECT_EQ(remove_file(in("a")), std::errc::no_such_file_or_directory);
  EXPECT_EQ(write_new(in("no folder/a"), "x"), std::errc::no_such_file_or_directory);
}

TEST_F(FilesTest, AreReadWhenTheyAreSmallAndRegular) {
  EXPECT_FALSE(write_new(in("a"), "a\r\nb"));
  EXPECT_EQ(read_small_file(in("a"), 4), "a\r\nb");
  EXPECT_EQ(read_small_file(in("a"), 3), std::nullopt);
  EXPECT_EQ(read_small_file(folder.string(), 100), std::nullopt);
  EXPECT_EQ(read_small_file(in("none"), 100), std::nullopt);
}

TEST_F(FilesTest, AreLockedAgainstTheSameProcessAndStillRead) {
  std::error_code error;
  std::optional<File> file = open_kept(in("a"), Access::group_reads, error);
  ASSERT_TRUE(*file) << error.message();
  EXPECT_FALSE(is_locked(in("a")));
  EXPECT_FALSE(lock_at_once(*file, Access::group_reads));
  EXPECT_FALSE(rewrite(*file, "a longer text"));
  EXPECT_FALSE(rewrite(*file, "text"));
  EXPECT_TRUE(is_locked(in("a")));
  EXPECT_EQ(read_small_file(in("a"), 100), "text");
  const File second = open_kept(in("a"), Access::group_reads, error);
  ASSERT_TRUE(second);
  EXPECT_EQ(lock_at_once(second, Access::group_reads), std::errc::resource_unavailable_try_again);
  file.reset();
  EXPECT_FALSE(is_locked(in("a")));
  EXPECT_FALSE(lock_at_once(second, Access::group_reads));
  EXPECT_FALSE(is_locked(in("none")));
}

TEST_F(FilesTest, AreHeldExclusivelyByOneAfterTheOther) {
  std::error_code error;
  std::optional<File> first = open_exclusively(in("lock"), error);
  ASSERT_TRUE(*first) << error.message();
  std::atomic<bool> is_second_in = false;
  std::thread other([&] {
    std::error_code failure;
    const File second = open_exclusively(in("lock"), failure);
    EXPECT_TRUE(second) << failure.message();
    is_second_in = true;
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_FALSE(is_second_in);
  first.reset();
  other.join();
  EXPECT_TRUE(is_second_in);
}

TEST_F(FilesTest, TellTheirStates) {
  EXPECT_EQ(state_of(in("a")).size, -1);
  EXPECT_FALSE(write_new(in("a"), "one"));
  const FileState one = state_of(in("a"));
  EXPECT_EQ(one.size, 3);
  EXPECT_FALSE(one.is_folder);
  EXPECT_FALSE(one.may_others_write);
  EXPECT_GT(one.written, 1'600'000'000LL * 1'000'000'000);
  EXPECT_TRUE(state_of(folder.string()).is_folder);
  EXPECT_FALSE(write_new(in("b"), "two"));
  EXPECT_NE(state_of(in("b")).number, one.number);
  EXPECT_EQ(owner_of(in("a")), current_user());
}

TEST_F(FilesTest, AreAddedToOrMadeAnew) {
  std::error_code error;
  for (const char* text : {"one\n", "two\n"}) {
    OpenLog log = open_log(in("log"), error);
    ASSERT_TRUE(log.file) << error.message();
    EXPECT_FALSE(write_all(log.file.get(), std::as_bytes(std::span(std::string_view(text)))));
  }
  EXPECT_EQ(content("log"), "one\ntwo\n");
  EXPECT_EQ(open_log(in("log"), error).size, 8U);
  std::string why;
  EXPECT_TRUE(open_anew(in("log"), why)) << why;
  EXPECT_EQ(content("log"), "");
  EXPECT_FALSE(open_anew(folder.string(), why));
  EXPECT_EQ(why, "it is no regular file");
  EXPECT_TRUE(open_spare());
}

TEST_F(FilesTest, AreInFoldersThatAreMadeAndTrusted) {
  EXPECT_FALSE(make_private_folder(in("own")));
  EXPECT_EQ(make_private_folder(in("own")), std::errc::file_exists);
  EXPECT_FALSE(make_shared_folder(in("shared")));
  EXPECT_FALSE(make_shared_folder(in("shared")));
  EXPECT_EQ(make_trusted_folder(in("c/d"), {.is_private = true}, in("c")).owner, current_user());
  EXPECT_TRUE(open_trusted_folder(in("c/d"), {.is_private = true}));
  EXPECT_FALSE(open_trusted_folder(in("c/e"), {.is_private = true}));
}

TEST(LocalSockets, ListenAtAPlaceThatIsTheirsAlone) {
  const std::string path =
      (fs::temp_directory_path() / ("rr-" + std::to_string(process_id()) + ".sock")).string();
  std::error_code error;
  PlacedSocket placed(path, false, error);
  if (error == std::errc::address_family_not_supported) {
    GTEST_SKIP() << "this system has no local sockets";
  }
  ASSERT_FALSE(error) << error.message();
  Descriptor socket;
  EXPECT_EQ(begin_connect(local_socket_address(path).value(), socket, error), Connecting::done);
  EXPECT_EQ(peer_user(socket.get()), current_user());
  {
    std::error_code taken;
    const PlacedSocket second(path, true, taken);
    EXPECT_EQ(taken, std::errc::address_in_use) << taken.message();
  }
  placed.take();  // nobody listens any more
  std::error_code refused;
  EXPECT_TRUE((PlacedSocket(path, false, refused), refused));
  PlacedSocket again(path, true, error);
  EXPECT_FALSE(error) << error.message();
  placed.remove();
  EXPECT_TRUE(fs::exists(fs::symlink_status(path)));
  again.remove();
  EXPECT_FALSE(fs::exists(fs::symlink_status(path)));
}

TEST(Users, HaveNames) {
  EXPECT_FALSE(current_account().name.empty());
  EXPECT_EQ(user_of(current_account().name), current_user());
  EXPECT_FALSE(user_of("no such user, surely"));
  EXPECT_NE(process_id(), 0U);
}

TEST(Clocks, GoTogether) {
  const auto exact = std::chrono::steady_clock::now();
  EXPECT_LT(std::chrono::abs(coarse_now() - exact), std::chrono::seconds(1));
  const std::tm parts = utc(86'400);
  EXPECT_EQ(parts.tm_year, 70);
  EXPECT_EQ(parts.tm_mday, 2);
  EXPECT_EQ(parts.tm_hour, 0);
}

}  // namespace
}  // namespace rr::platform
