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
    EXPECT_THAT(std::string(entry.name), MatchesRegex("R(0[1-9]|10)[0-9][0-9]"));
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
  report.set_level(Code::R0136, Level::allow);
  report.set_level(Code::R0107, Level::allow);
  report.add(Code::R0136, {first_file, 0, 1}, "warning");
  report.add(Code::R0107, {first_file, 0, 1}, "error");
  EXPECT_THAT(messages(report), ElementsAre("error"));
}

TEST(Report, ADeniedWarningIsAnErrorButTheDefinitionIsRight) {
  Report report;
  report.set_level(Code::R0136, Level::deny);
  report.add(Code::R0610, {first_file, 0, 1}, "usual");
  EXPECT_FALSE(report.has_errors());
  report.add(Code::R0136, {first_file, 4, 5}, "denied").note("more");
  EXPECT_TRUE(report.has_errors());
  EXPECT_EQ(report.errors(), 0U);
  EXPECT_EQ(report.sorted()[0]->severity(), Severity::warning);
  EXPECT_EQ(report.sorted()[1]->severity(), Severity::error);
  EXPECT_THAT(report.sorted()[1]->notes(), ElementsAre("a warning that is denied", "more"));
}

TEST(Report, NothingIsDeniedInATextFromTheNetwork) {
  Report report(Origin::network);
  report.set_level(Code::R0136, Level::deny);
  report.add(Code::R0136, {first_file, 4, 5}, "denied");
  EXPECT_FALSE(report.has_errors());
  EXPECT_EQ(report.sorted().front()->severity(), Severity::warning);
}

TEST(Report, AWarningMayBeAllowedAtItsPlace) {
  Report report;
  report.set_level(Code::R0136, Level::deny);
  report.allow_at(Code::R0136, {first_file, 10, 20}, {first_file, 10, 12});
  report.add(Code::R0136, {first_file, 20, 21}, "behind");
  report.add(Code::R0136, {first_file, 19, 25}, "allowed");
  report.add(Code::R0610, {first_file, 15, 16}, "another code");
  report.add(Code::R0136, {second_file, 15, 16}, "another file");
  EXPECT_THAT(messages(report), ElementsAre("another code", "behind", "another file"));
}

TEST(Report, WhatIsDeniedAndAllowedAtItsPlaceIsNoError) {
  Report report;
  report.set_level(Code::R0136, Level::deny);
  report.add(Code::R0136, {first_file, 15, 16}, "first");
  EXPECT_TRUE(report.has_errors());
  report.allow_at(Code::R0136, {first_file, 10, 20}, {first_file, 10, 12});
  EXPECT_FALSE(report.has_errors());
}

TEST(Report, WhatIsAllowedInVainIsAWarning) {
  Report report;
  report.allow_at(Code::R0136, {first_file, 10, 40}, {first_file, 11, 12});
  report.allow_at(Code::R0136, {first_file, 30, 40}, {first_file, 31, 32});
  report.allow_at(Code::R0904, {first_file, 10, 40}, {first_file, 13, 14});
  report.add(Code::R0136, {first_file, 35, 36}, "allowed");
  report.report_unused_allows();
  EXPECT_THAT(messages(report), ElementsAre("there is no `R0136` to be allowed"));
  EXPECT_EQ(report.sorted().front()->primary().span, (Span{first_file, 11, 12}));
}

TEST(Report, OfTargetsShowsWhatDiffersAtOnePlace) {
  Report report;
  report.add(Code::R0903, {first_file, 4, 9}, "`class` is reserved in C++");
  report.add(Code::R0903, {first_file, 4, 9}, "`class` is reserved in C#");
  report.add(Code::R0903, {first_file, 4, 9}, "`class` is reserved in C#");
  EXPECT_THAT(messages(report),
              ElementsAre("`class` is reserved in C++", "`class` is reserved in C#"));
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

TEST(Report, AWordOfAMegabyteIsNotPrintedWhole) {
  Report report;
  const std::string word(1'000'000, 'x');
  Diagnostic& diagnostic = report.add(Code::R0203, {}, "unknown type `" + word + "` here");
  diagnostic.label(word).help(word + " and " + word).note(word).also({}, word);
  EXPECT_EQ(diagnostic.message(), "unknown type `" + std::string(99, 'x') + "... here");
  EXPECT_LT(diagnostic.primary().text.size() + diagnostic.helps()[0].size() +
                diagnostic.notes()[0].size() + diagnostic.secondary()[0].text.size(),
            1000U);
  EXPECT_EQ(shortened("a  b "), "a  b ");
}

TEST(Report, AChangeBelongsToTheHelpBeforeIt) {
  Report report;
  Diagnostic& found = report.add(Code::R0203, {SourceId{}, 4, 7}, "unknown");
  found.edit({SourceId{}, 0, 1}, "no help asks for it");
  found.help("first").edit({SourceId{}, 4, 7}, "one").edit({SourceId{}, 0, 0}, "two");
  found.help("second");
  ASSERT_EQ(found.edits_of(0).size(), 2);
  EXPECT_EQ(found.edits_of(0)[0].text, "one");
  EXPECT_EQ(found.edits_of(0)[1].span, (Span{SourceId{}, 0, 0}));
  EXPECT_TRUE(found.edits_of(1).empty());
}

}  // namespace
}  // namespace robdef
