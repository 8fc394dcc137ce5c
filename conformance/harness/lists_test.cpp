// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/lists.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <stdexcept>

namespace rr::conformance {
namespace {

namespace fs = std::filesystem;

class Lists : public testing::Test {
 protected:
  ~Lists() override { fs::remove(file_); }

  fs::path write(const std::string& text) {
    std::ofstream(file_) << text;
    return file_;
  }

  fs::path file_ =
      fs::temp_directory_path() / ("conformance_lists_" + std::to_string(::getpid()) + "_" +
                                   testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(Lists, AnEntryIsFoundByItsRunAndPlace) {
  const Deviations list(write("# a comment\n\na | v2 v4 | service | step 3 | closed | why\n"));
  ASSERT_EQ(list.entries().size(), 1U);
  const ListEntry* found = list.find({"a", "v4", Role::service}, step_place(3));
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->instead(), "closed");
  EXPECT_EQ(found->reason(), "why");
  EXPECT_EQ(list.find({"a", "v4st", Role::service}, step_place(3)), nullptr);
  EXPECT_EQ(list.find({"a", "v4", Role::client}, step_place(3)), nullptr);
  EXPECT_EQ(list.find({"a", "v4", Role::service}, step_place(30)), nullptr);
}

TEST_F(Lists, AStarIsEverything) {
  const Deviations list(write("* | * | * | frame 4 | absent | why\n"));
  EXPECT_NE(list.find({"b", "v4st", Role::client}, frame_place(4)), nullptr);
}

TEST_F(Lists, AnEntryMayBeAboutSomeChannelsOnly) {
  const Deviations list(write("a over tls ws | * | service | step 3 | closed | why\n"));
  EXPECT_EQ(list.find({"a", "v4", Role::service}, step_place(3)), nullptr);
  for (const char* channel : {"tls", "ws"}) {
    EXPECT_NE(list.find({"a", "v4", Role::service, channel}, step_place(3)), nullptr) << channel;
  }
}

TEST_F(Lists, OnlyTheEntriesOfTheLanguageCount) {
  const ExpectedFailures list(write("cpp | a | * | * | * | why\nmatlab | b | * | * | * | why\n"),
                              "cpp");
  EXPECT_NE(list.find({"a", "v2", Role::service}, whole_run), nullptr);
  EXPECT_EQ(list.find({"b", "v2", Role::service}, whole_run), nullptr);
}

TEST_F(Lists, ALineWithoutReasonOrWithTooFewFieldsIsRefused) {
  EXPECT_THROW(Deviations(write("a | v2 | service | step 3 | closed |\n")), std::runtime_error);
  EXPECT_THROW(Deviations(write("a | v2 | service\n")), std::runtime_error);
  EXPECT_THROW(Deviations("/nowhere/at/all"), std::runtime_error);
}

}  // namespace
}  // namespace rr::conformance
