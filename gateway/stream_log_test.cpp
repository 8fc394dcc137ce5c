// SPDX-License-Identifier: Apache-2.0
#include "gateway/stream_log.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include "gateway/testing/folder.hpp"
#include "rr/error.hpp"

namespace rr::gateway {
namespace {

using testing::Folder;

std::vector<std::byte> body(std::string_view text) {
  const auto* const bytes = reinterpret_cast<const std::byte*>(text.data());
  return {bytes, bytes + text.size()};
}

std::vector<std::uint64_t> numbers(StreamLog& log, std::uint64_t from = 1) {
  std::vector<std::uint64_t> all;
  while (auto record = log.read_from(from)) {
    all.push_back(record->number);
    from = record->number + 1;
  }
  return all;
}

std::vector<std::string> files(const std::string& folder) {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".log") paths.push_back(entry.path().string());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

TEST(GatewayStreamLog, GivesBackWhatItWasGiven) {
  const Folder folder;
  StreamLog log(folder.path(), {});
  EXPECT_FALSE(log.read_from(1).has_value());
  EXPECT_EQ(log.append(7, "double", body("one"), 11), 1U);
  EXPECT_EQ(log.append(8, "", body(""), 12), 2U);
  const auto first = log.read_from(1);
  ASSERT_TRUE(first.has_value());
  EXPECT_EQ(first->kind, 7U);
  EXPECT_EQ(first->label, "double");
  EXPECT_EQ(first->body, body("one"));
  EXPECT_EQ(first->time, 11);
  const auto second = log.read_from(2);
  ASSERT_TRUE(second.has_value());
  EXPECT_EQ(second->kind, 8U);
  EXPECT_TRUE(second->body.empty());
  EXPECT_FALSE(log.read_from(3).has_value());
}

TEST(GatewayStreamLog, GoesOnWhereItEnded) {
  const Folder folder;
  std::uint64_t epoch = 0;
  {
    StreamLog log(folder.path(), {});
    epoch = log.epoch();
    log.append(1, "", body("one"), 1);
  }
  StreamLog log(folder.path(), {});
  EXPECT_EQ(log.epoch(), epoch);
  EXPECT_EQ(log.append(1, "", body("two"), 2), 2U);
  EXPECT_EQ(numbers(log), (std::vector<std::uint64_t>{1, 2}));
}

TEST(GatewayStreamLog, KeepsItsNumbersWhenAllIsDiscarded) {
  const Folder folder;
  {
    StreamLog log(folder.path(), {.file_bytes = 1});
    constexpr std::int64_t today = 1'795'779'856'000'000'000;
    for (int i = 0; i < 5; ++i) log.append(1, "", body("x"), today);
    log.discard_through(5);
    log.discard_old(today + std::chrono::nanoseconds(std::chrono::hours(24 * 365)).count());
    EXPECT_TRUE(numbers(log).empty());
    EXPECT_EQ(files(folder.path()).size(), 1U);
  }
  StreamLog log(folder.path(), {});
  EXPECT_EQ(log.last(), 5U);
  EXPECT_EQ(log.append(1, "", body("x"), 1), 6U);
}

TEST(GatewayStreamLog, DropsTheOldestWhenItIsFull) {
  const Folder folder;
  StreamLog log(folder.path(), {.bytes = 10'000, .file_bytes = 1'000});
  for (int i = 0; i < 1'000; ++i) log.append(1, "", std::vector<std::byte>(68), 1);
  EXPECT_LE(log.size(), 11'100U);
  const auto kept = numbers(log);
  EXPECT_GE(kept.size(), 80U);
  EXPECT_EQ(kept.back(), 1'000U);
  EXPECT_EQ(kept.front(), 1'000U - kept.size() + 1);
}

TEST(GatewayStreamLog, CutsOffWhatWasWrittenInPart) {
  const Folder folder;
  {
    StreamLog log(folder.path(), {});
    for (const char* text : {"one", "two", "three"}) log.append(1, "", body(text), 1);
  }
  const std::string path = files(folder.path()).at(0);
  const auto whole = std::filesystem::file_size(path);
  for (std::size_t cut = 1; cut < 37; ++cut) {
    std::filesystem::resize_file(path, whole - cut);
    StreamLog log(folder.path(), {});
    EXPECT_EQ(log.last(), 2U) << cut;
    EXPECT_EQ(log.append(1, "", body("three"), 1), 3U);
    EXPECT_EQ(numbers(log), (std::vector<std::uint64_t>{1, 2, 3}));
  }
}

TEST(GatewayStreamLog, AFlippedBitIsAGap) {
  const Folder folder;
  StreamLog log(folder.path(), {.file_bytes = 100});
  for (int i = 0; i < 10; ++i) log.append(1, "", std::vector<std::byte>(20), 1);
  std::fstream file(files(folder.path()).at(1), std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(32 + 40);
  file.put('!');
  file.close();
  // Two records of 52 bytes in each file.
  EXPECT_EQ(numbers(log), (std::vector<std::uint64_t>{1, 2, 5, 6, 7, 8, 9, 10}));
}

TEST(GatewayStreamLog, AnyCutOfAFileIsOpenedOrRefused) {
  const Folder folder;
  {
    StreamLog log(folder.path(), {.file_bytes = 100});
    for (int i = 0; i < 10; ++i) log.append(1, "", std::vector<std::byte>(20), 1);
  }
  const std::string last = files(folder.path()).back();
  for (std::size_t size = std::filesystem::file_size(last); size-- > 0;) {
    std::filesystem::resize_file(last, size);
    StreamLog log(folder.path(), {.file_bytes = 100});
    EXPECT_GE(log.last(), 8U);
    if (files(folder.path()).back() != last) break;
  }
  EXPECT_EQ(files(folder.path()).size(), 4U);
}

TEST(GatewayStreamLog, IsForOneProcess) {
  const Folder folder;
  const StreamLog log(folder.path(), {});
  try {
    const StreamLog other(folder.path(), {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::invalid_state);
  }
}

TEST(GatewayStreamLog, ForeignFilesAreRefused) {
  const Folder folder;
  std::ofstream(folder.path() + "/00000000000000000001.log") << std::string(64, 'x');
  EXPECT_THROW(StreamLog(folder.path(), {}), Error);
}

// The child is killed in the middle of appending: all that append() has returned for is there.
TEST(GatewayStreamLog, SurvivesAKilledProcess) {
  const Folder folder;
  int pipe[2];
  ASSERT_EQ(::pipe(pipe), 0);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    StreamLog log(folder.path(), {});
    for (;;) {
      const std::uint64_t number = log.append(1, "label", std::vector<std::byte>(1000), 1);
      if (::write(pipe[1], &number, sizeof number) < 0) ::_exit(1);
    }
  }
  std::uint64_t number = 0;
  while (number < 500) ASSERT_EQ(::read(pipe[0], &number, sizeof number), 8);
  ::kill(child, SIGKILL);
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  ::close(pipe[1]);
  while (::read(pipe[0], &number, sizeof number) == 8) {
  }
  ::close(pipe[0]);
  StreamLog log(folder.path(), {});
  EXPECT_GE(log.last(), number);
  EXPECT_EQ(numbers(log).size(), log.last());
}

// A limit of the process on the size of files stands for a disk that is full.
TEST(GatewayStreamLog, ARefusedRecordIsAGap) {
  const Folder folder;
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    ::alarm(30);
    StreamLog log(folder.path(), {});
    log.append(1, "", body("one"), 1);
    testing::limit_file_size(2'000);
    bool is_refused = false;
    try {
      log.append(1, "", std::vector<std::byte>(5'000), 1);
    } catch (const Error& error) {
      is_refused = error.code() == ErrorCode::io_error;
    }
    const std::uint64_t third = log.append(1, "", body("three"), 1);
    const auto all = numbers(log);
    ::_exit(is_refused && third == 3 && all == std::vector<std::uint64_t>{1, 3} ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
}

}  // namespace
}  // namespace rr::gateway
