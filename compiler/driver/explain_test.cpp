// SPDX-License-Identifier: Apache-2.0
#include "compiler/driver/explain.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <sstream>
#include <stdexcept>

#include "compiler/driver/depfile.hpp"
#include "compiler/driver/run.hpp"

namespace robdef {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

struct Outcome {
  ExitStatus status{};
  std::string out;
  std::string err;
};

Outcome run(const std::vector<std::string>& arguments) {
  std::ostringstream out;
  std::ostringstream err;
  const ExitStatus status = robdef::run(arguments, "", compiler_commands(), out, err);
  return {status, out.str(), err.str()};
}

TEST(Explain, ACodeIsExplainedInEitherCase) {
  const Outcome outcome = run({"explain", "r0203"});
  EXPECT_EQ(outcome.status, exit_fine);
  EXPECT_THAT(outcome.out, StartsWith("error[R0203] (rule V12): a type that does not exist\n\n"));
  EXPECT_THAT(outcome.out, HasSubstr(std::string(entry_of(Code::R0203).explanation)));
  EXPECT_EQ(run({"explain", "R0203"}).out, outcome.out);
}

TEST(Explain, ARuleStandsForAllItsCodes) {
  const std::string text = run({"explain", "P30"}).out;
  EXPECT_THAT(text, HasSubstr("error[R0301] (rule P30)"));
  EXPECT_THAT(text, HasSubstr("error[R0302] (rule P30)"));
}

TEST(Explain, AnUnknownCodeIsAMistakeInTheCommandLine) {
  const Outcome outcome = run({"explain", "R0203", "R9999"});
  EXPECT_EQ(outcome.status, exit_usage);
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(outcome.err, HasSubstr("no code, rule or group `R9999`"));
}

TEST(Explain, TheListHasEachCodeOnceWithRuleAndSeverity) {
  const std::string text = run({"explain", "--list"}).out;
  EXPECT_THAT(text, StartsWith("R0101  L1   error    a character that a definition cannot hold\n"));
  std::istringstream lines(text);
  std::set<std::string> codes;
  std::string line;
  while (std::getline(lines, line) && !line.empty())
    EXPECT_TRUE(codes.insert(line.substr(0, 5)).second) << line;
  EXPECT_EQ(codes.size(), code_entries().size());
}

TEST(Explain, GroupsOfWarningsStandBelowTheList) {
  EXPECT_THAT(run({"explain", "--list"}).out,
              AllOf(HasSubstr("\n\nwarnings     all warnings\n"),
                    HasSubstr("\ntarget       what a language changes or leaves out: R0903, "
                              "R0904, R1002\n")));
  EXPECT_THAT(run({"explain", "target"}).out,
              AllOf(StartsWith("warning[R0903]"), HasSubstr("\nwarning[R0904]")));
  EXPECT_THAT(run({"explain", "warnings"}).out,
              AllOf(HasSubstr("warning[R0136]"), Not(HasSubstr("error["))));
}

TEST(Explain, JsonHasTheRuleBesideTheCode) {
  const std::string all = run({"explain", "--list", "--json"}).out;
  EXPECT_THAT(all, StartsWith("[\n"));
  EXPECT_THAT(all, HasSubstr("\"code\": \"R0203\",\n    \"rule\": \"V12\",\n    \"severity\": "
                             "\"error\",\n    \"summary\": \"a type that does not exist\""));
  EXPECT_THAT(run({"explain", "--json", "V12"}).out, HasSubstr("\"code\": \"R0203\""));
}

TEST(Explain, EachCodeHasARuleOrIsTheCompilersOwnAndSaysMoreThanItsSummary) {
  for (const CodeEntry& entry : code_entries()) {
    EXPECT_FALSE(entry.summary.empty()) << entry.name;
    EXPECT_GT(entry.explanation.size(), entry.summary.size()) << entry.name;
  }
}

TEST(Depfile, TargetsAndInputsAreEscapedForMake) {
  EXPECT_EQ(depfile_text({"out/a b.hpp", "out/$c.cpp"}, {"de#f.robdef", "x.robdef"}),
            "out/a\\ b.hpp out/$$c.cpp: \\\n  de\\#f.robdef \\\n  x.robdef\n");
}

TEST(Guard, WhatIsThrownIsAFaultOfTheProgramAndSaysSo) {
  std::ostringstream err;
  EXPECT_EQ(guard([]() -> ExitStatus { throw std::logic_error("no such partial"); }, err),
            exit_fault);
  EXPECT_THAT(err.str(), StartsWith("robdef: this is a fault of robdef, not of your definition: "
                                    "no such partial\nPlease report it"));
}

TEST(Guard, ResultsPassThrough) {
  std::ostringstream err;
  EXPECT_EQ(guard([] { return exit_errors; }, err), exit_errors);
  EXPECT_EQ(err.str(), "");
}

}  // namespace
}  // namespace robdef
