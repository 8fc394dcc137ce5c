// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

namespace rr::conformance {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

Result result(const std::string& scenario, std::vector<Fault> faults = {}) {
  Result made;
  made.run = {scenario, "v2", Role::service};
  made.checked = 1;
  made.faults = std::move(faults);
  return made;
}

class ReportTest : public testing::Test {
 protected:
  ~ReportTest() override { fs::remove(file_); }

  const ExpectedFailures& expect(const std::string& text) {
    std::ofstream(file_) << text;
    return expected_ = ExpectedFailures(file_, "cpp");
  }

  fs::path file_ =
      fs::temp_directory_path() / ("conformance_report_" + std::to_string(::getpid()) + "_" +
                                   testing::UnitTest::GetInstance()->current_test_info()->name());
  ExpectedFailures expected_;
  Deviations deviations_;
};

TEST_F(ReportTest, AllPassedHolds) {
  Report report("cpp", expected_, deviations_, true);
  report.add(result("a"));
  EXPECT_TRUE(report.holds());
  std::ostringstream text;
  report.print(text);
  EXPECT_THAT(text.str(), HasSubstr("all holds"));
}

TEST_F(ReportTest, EachChannelHasItsRows) {
  Report report("cpp", expect("cpp | a over ws | * | * | * | why\n"), deviations_, true);
  report.add(result("a"));
  EXPECT_TRUE(report.holds());  // the entry is of a channel that was not played
  Result by_web_socket = result("a");
  by_web_socket.run.channel = "ws";
  report.add(by_web_socket);
  EXPECT_FALSE(report.holds());
  std::ostringstream text;
  report.print(text);
  EXPECT_THAT(text.str(), HasSubstr("tcp      .         .         pass"));
  EXPECT_THAT(text.str(), HasSubstr("ws       .         .         FAIL"));
  EXPECT_THAT(text.str(), HasSubstr("a v2 service over ws, *: "));
}

TEST_F(ReportTest, NothingPlayedDoesNotHold) {
  const Report report("cpp", expected_, deviations_, true);
  EXPECT_FALSE(report.holds());
}

TEST_F(ReportTest, AFaultIsShownWithItsPlace) {
  Report report("cpp", expected_, deviations_, true);
  report.add(result("a", {{"step 3", "get x", "other bytes"}}));
  EXPECT_FALSE(report.holds());
  std::ostringstream text;
  report.print(text);
  EXPECT_THAT(text.str(), HasSubstr("a v2 service, step 3 (get x): other bytes"));
  EXPECT_EQ(report.json()["cells"][0]["outcome"], "FAIL");
}

TEST_F(ReportTest, AnExpectedFailureIsNoFault) {
  Report report("cpp", expect("cpp | a | * | service | step 3 | later\n"), deviations_, true);
  report.add(result("a", {{"step 3", "get x", "other bytes"}}));
  EXPECT_TRUE(report.holds());
  EXPECT_EQ(report.json()["cells"][0]["outcome"], "pass -1");
}

TEST_F(ReportTest, AnExpectedFailureThatPassesIsAFault) {
  Report report("cpp", expect("cpp | a | * | service | step 3 | later\n"), deviations_, true);
  report.add(result("a"));
  EXPECT_FALSE(report.holds());
}

TEST_F(ReportTest, AWholeRunThatIsExpectedToFailShowsItsReason) {
  Report report("cpp", expect("cpp | a | * | * | * | pipes come later\n"), deviations_, true);
  report.add(result("a", {{"step 3", "", "x"}, {"step 4", "", "y"}}));
  EXPECT_TRUE(report.holds());
  std::ostringstream text;
  report.print(text);
  EXPECT_THAT(text.str(), HasSubstr("pipes come later: a"));
}

TEST_F(ReportTest, AWholeRunThatPassesThoughListedIsAFault) {
  Report report("cpp", expect("cpp | a | * | * | * | pipes come later\n"), deviations_, true);
  report.add(result("a"));
  EXPECT_FALSE(report.holds());
}

TEST_F(ReportTest, AnEntryThatNothingMeetsIsAFaultOfACompleteRun) {
  const ExpectedFailures& list = expect("cpp | nowhere | * | * | * | later\n");
  Report complete("cpp", list, deviations_, true);
  complete.add(result("a"));
  EXPECT_FALSE(complete.holds());
  Report partial("cpp", list, deviations_, false);
  partial.add(result("a"));
  EXPECT_TRUE(partial.holds());
}

TEST_F(ReportTest, ABorrowedDeviationThatNothingMeetsIsNoFault) {
  std::ofstream(file_) << "* | * | service | message without entries | closed | it is malformed\n";
  const Deviations own(file_);
  const Deviations borrowed(file_, true);
  Report with_own("cpp", expected_, own, true);
  with_own.add(result("a"));
  EXPECT_FALSE(with_own.holds());
  Report with_borrowed("cpp", expected_, borrowed, true);
  with_borrowed.add(result("a"));
  EXPECT_TRUE(with_borrowed.holds());
}

}  // namespace
}  // namespace rr::conformance
