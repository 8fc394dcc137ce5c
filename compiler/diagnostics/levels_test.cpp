// SPDX-License-Identifier: Apache-2.0
#include "compiler/diagnostics/levels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace robdef {
namespace {

TEST(Levels, EachWarningIsInOneGroupBesideAll) {
  for (const CodeEntry& entry : code_entries()) {
    if (entry.name.starts_with("R07")) continue;
    const auto groups = std::ranges::count_if(warning_groups(), [&](const WarningGroup& group) {
      return std::ranges::find(group.codes, entry.code) != group.codes.end();
    });
    EXPECT_EQ(groups, entry.severity == Severity::warning ? 1 : 0) << entry.name;
  }
  EXPECT_EQ(warning_groups().front().name, "warnings");
}

TEST(Levels, ACodeCountsMoreThanItsGroupAndThatMoreThanAll) {
  Levels levels;
  EXPECT_EQ(levels.find(Code::R0610), std::nullopt);
  EXPECT_EQ(levels.set("r0610", Level::allow), "");
  EXPECT_EQ(levels.set("unused", Level::warn), "");
  EXPECT_EQ(levels.set("warnings", Level::deny), "");
  EXPECT_EQ(levels.find(Code::R0610), Level::allow);
  EXPECT_EQ(levels.find(Code::R0611), Level::warn);
  EXPECT_EQ(levels.find(Code::R0136), Level::deny);
}

TEST(Levels, TheFirstPlaceThatSaysSomethingCounts) {
  Levels command_line;
  Levels file;
  EXPECT_EQ(command_line.set("unused", Level::warn), "");
  EXPECT_EQ(file.set("R0610", Level::deny), "");
  EXPECT_EQ(file.set("R0136", Level::deny), "");
  Report report;
  set_levels(report, {&command_line, &file});
  report.add(Code::R0610, {}, "warning");
  EXPECT_FALSE(report.has_errors());
  report.add(Code::R0136, {}, "denied");
  EXPECT_TRUE(report.has_errors());
}

TEST(Levels, SayWhatIsWrongWithAName) {
  Levels levels;
  EXPECT_EQ(levels.set("R0203", Level::allow),
            "`R0203` is an error; only warnings can be turned off");
  EXPECT_EQ(levels.set("R0771", Level::deny), "`R0771` is of `robdef breaking`");
  EXPECT_EQ(levels.set("unusde", Level::deny),
            "there is no code or group `unusde`; did you mean `unused`?");
  EXPECT_EQ(levels.set("R0619", Level::deny),
            "there is no code or group `R0619`; did you mean `R0610`?");
  EXPECT_EQ(levels.set("everything at all", Level::deny),
            "there is no code or group `everything at all`; see `robdef explain --list`");
}

TEST(Levels, HaveThreeWords) {
  EXPECT_EQ(level_of("allow"), Level::allow);
  EXPECT_EQ(level_of("warn"), Level::warn);
  EXPECT_EQ(level_of("deny"), Level::deny);
  EXPECT_EQ(level_of("forbid"), std::nullopt);
}

}  // namespace
}  // namespace robdef
