// SPDX-License-Identifier: Apache-2.0
#include "compiler/diagnostics/report.hpp"

#include <gmock/gmock.h>

#include <set>
#include <string>

namespace robdef {
namespace {

using ::testing::ElementsAre;
using ::testing::MatchesRegex;

constexpr SourceId first_file{0};
constexpr SourceId second_file{1};

std::vector<std::string> messages(const Report& report) {
  std::vector<std::string> result;
  for (const Diagnostic* diagnostic : report.sorted()) result.push_back(diagnostic->message());
  return result;
}

TEST(Codes, EachHasANameTextsAndItsRangeOfNumbers) {
  std::set<std::string_view> names;
  for (const CodeEntry& entry : code_entries()) {
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
    EXPECT_THAT(std::string(entry.name), MatchesRegex("R0[1-69][0-9][0-9]"));
    EXPECT_THAT(std::string(entry.rule), MatchesRegex("([LPSVTWQ][0-9]+)?")) << entry.name;
    EXPECT_FALSE(entry.summary.empty() || entry.summary.ends_with('.')) << entry.name;
    EXPECT_FALSE(entry.explanation.empty() || entry.explanation.starts_with('\n')) << entry.name;
    EXPECT_EQ(&entry_of(entry.code), &entry);
    EXPECT_EQ(find_code(entry.name), &entry);
  }
  EXPECT_EQ(find_code("R9999"), nullptr);
}

TEST(Codes, ThereIsOneForEachRuleOfTheLanguage) {
  std::set<std::string> rules;
  for (const CodeEntry& entry : code_entries()) rules.emplace(entry.rule);
  const auto expect_all = [&rules](char letter, int last) {
    for (int number = 1; number <= last; ++number) {
      const std::string digits = std::to_string(number);
      const bool is_padded = number < 10 && (letter == 'P' || letter == 'V' || letter == 'Q');
      const std::string rule = letter + std::string(is_padded ? "0" : "") + digits;
      EXPECT_TRUE(rules.contains(rule)) << rule;
    }
  };
  expect_all('L', 6);
  expect_all('P', 34);
  expect_all('S', 1);
  expect_all('V', 27);
  expect_all('T', 1);
  expect_all('W', 5);
  expect_all('Q', 24);
}

TEST(Report, IsInTheOrderOfFilesAndPlaces) {
  Report report;
  report.add(Code::R0203, {second_file, 0, 1}, "second file");
  report.add(Code::R0203, {first_file, 9, 10}, "first file, later");
  report.add(Code::R0136, {first_file, 2, 3}, "first file, warning");
  EXPECT_THAT(messages(report),
              ElementsAre("first file, warning", "first file, later", "second file"));
}

TEST(Report, SaysTheSameThingAboutAPlaceOnce) {
  Report report;
  report.add(Code::R0203, {first_file, 4, 9}, "once");
  report.add(Code::R0203, {first_file, 4, 9}, "twice");
  report.add(Code::R0205, {first_file, 4, 9}, "something else");
  EXPECT_THAT(messages(report), ElementsAre("once", "something else"));
}

TEST(Report, CountsErrorsOnly) {
  Report report;
  report.add(Code::R0136, {first_file, 0, 1}, "warning");
  EXPECT_FALSE(report.has_errors());
  report.add(Code::R0107, {first_file, 0, 1}, "error");
  EXPECT_TRUE(report.has_errors());
  EXPECT_EQ(report.errors(), 1U);
}

TEST(Report, WarningsCanBeSilencedAndErrorsCannot) {
  Report report;
  report.silence(Code::R0136);
  report.silence(Code::R0107);
  report.add(Code::R0136, {first_file, 0, 1}, "warning");
  report.add(Code::R0107, {first_file, 0, 1}, "error");
  EXPECT_THAT(messages(report), ElementsAre("error"));
}

TEST(Report, KeepsTwoFurtherPlacesAtMost) {
  Report report;
  Diagnostic& diagnostic = report.add(Code::R0204, {first_file, 0, 1}, "many places");
  for (std::uint32_t i = 1; i <= 5; ++i) diagnostic.also({first_file, i, i + 1}, "here");
  EXPECT_EQ(diagnostic.secondary().size(), 2U);
}

TEST(Report, ReferencesStayValidWhileFindingsAreAdded) {
  Report report;
  Diagnostic& diagnostic = report.add(Code::R0107, {first_file, 0, 1}, "first");
  for (std::uint32_t i = 1; i < 1000; ++i) report.add(Code::R0107, {first_file, i, i + 1}, "more");
  diagnostic.help("late");
  EXPECT_THAT(report.sorted().front()->helps(), ElementsAre("late"));
}

}  // namespace
}  // namespace robdef
