// SPDX-License-Identifier: Apache-2.0
#include "compiler/model/check.hpp"

#include <string>

#include "compiler/model/compiled.hpp"
#include "compiler/model/resolve.hpp"
#include "compiler/syntax/read.hpp"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace robdef::model {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

std::string message(const Compiled& result, std::size_t index = 0) {
  return result.report->sorted().at(index)->message();
}

TEST(Check, AllMistakesOfAllFilesAreReportedInTheirOrder) {
  const Compiled result =
      compiled({"service a.x\nstdver 0.10\nimport b.x\n"
                "struct struct\nfield string[] a\nend\n",
                "service b.x\nstdver 0.10\npod P\nfield double[] a\nend\n"});
  EXPECT_THAT(result.codes(), ElementsAre("R0205", "R0206", "R0401"));
}

TEST(Check, NamesThatGeneratedCodeUsesAreRefusedInAnyCase) {
  const Compiled result = compiled_lines(
      "object O\nproperty double GET_x\nproperty double RobotRaconteurX\nproperty double getx\n"
      "property double This\nproperty double self\nend\n");
  EXPECT_THAT(result.codes(), ElementsAre("R0205", "R0205", "R0205"));
  EXPECT_EQ(result.marked(2), "self");
}

TEST(Check, TwoServiceNamesOfTheSystemAreExempt) {
  EXPECT_THAT(compiled({"service RobotRaconteurServiceIndex\n"}).codes(), IsEmpty());
  EXPECT_THAT(compiled({"service RobotRaconteurTestService2\n"}).codes(), IsEmpty());
  EXPECT_THAT(compiled({"service RobotRaconteurOther\n"}).codes(), ElementsAre("R0201"));
}

TEST(Check, ASecondDeclarationPointsToTheFirst) {
  const Compiled result = compiled_lines("constant int32 S 1\nstruct S\nfield double x\nend\n");
  EXPECT_THAT(result.codes(), ElementsAre("R0204"));
  const Diagnostic& finding = *result.report->sorted()[0];
  ASSERT_THAT(finding.secondary(), SizeIs(1));
  EXPECT_EQ(finding.secondary()[0].text, "first declared here, as a constant");
  EXPECT_LT(finding.secondary()[0].span.begin, finding.primary().span.begin);
}

TEST(Check, ObjectsAreNotValues) {
  const Compiled result =
      compiled_lines("object Sub\nevent e()\nend\nobject O\nfunction Sub f(Sub{list} a)\nend\n");
  EXPECT_THAT(result.codes(), ElementsAre("R0206", "R0206"));
  EXPECT_EQ(result.help(0), "write `objref Sub` and a name to refer to one");
}

TEST(Check, VoidIsABareReturnTypeAndNothingElse) {
  const Compiled result = compiled_lines(
      "struct S\nfield void a\nend\npod P\nfield void b\nend\n"
      "object O\nfunction void f()\ncallback void c()\nfunction void{list} g()\n"
      "wire void w\nmemory void[] m\nend\n");
  EXPECT_THAT(result.codes(), ElementsAre("R0207", "R0207", "R0207", "R0207", "R0207"));
}

TEST(Check, GeneratorsBelongToFunctions) {
  const Compiled result = compiled_lines(
      "struct S\nfield double{generator} a\nend\n"
      "object O\nevent e(double{generator} a)\ncallback double{generator} c()\n"
      "function void{generator} f()\nfunction double g(double{generator} a)\n"
      "function void h(double{generator} a, int32 b)\nend\n");
  EXPECT_THAT(result.codes(), ElementsAre("R0601", "R0601", "R0601", "R0601", "R0601", "R0601"));
  EXPECT_EQ(result.marked(4), "double");
}

TEST(Check, AMemoryOfStructArraysIsReportedOnce) {
  const Compiled result = compiled_lines(
      "struct S\nfield double x\nend\nobject O\nmemory S[] a\nmemory S b\nmemory double[0-] c\n"
      "memory double[0] d\nend\n");
  EXPECT_THAT(result.codes(), ElementsAre("R0206", "R0604", "R0421", "R0604"));
}

TEST(Check, AModifierOfAnotherKindIsAWarning) {
  const Compiled result = compiled_lines(
      "object O\nfunction void f() [readonly]\nproperty double p [shiny]\n"
      "property double q [urgent(1)]\nproperty double r [redonly(1)]\nend\n");
  EXPECT_THAT(result.codes(), ElementsAre("R0610", "R0610", "R0610", "R0610"));
  EXPECT_FALSE(result.report->has_errors());
  EXPECT_EQ(message(result), "`readonly` has no effect on a function");
  EXPECT_EQ(message(result, 2), "`urgent` takes no arguments");
}

TEST(Check, AModifierThatIsCloseToOneOfTheLanguageIsAnError) {
  const Compiled result = compiled_lines(
      "object O\nproperty double p [redonly]\nproperty double q [ReadOnly, no_lock]\nend\n"
      "struct S\nfield double f [urgnt]\nend\n");
  EXPECT_THAT(result.errors(), ElementsAre("R0613", "R0613", "R0613", "R0613"));
  EXPECT_EQ(result.help(0), "write `readonly`");
  EXPECT_EQ(result.help(2), "write `nolock`");
}

TEST(Check, ATextFromAPeerIsNeverRefusedForAModifier) {
  Sources sources;
  Report report(Origin::network);
  const ast::Program program = ast::read_texts(
      {{"a", "service a\nstdver 0.10\nobject O\nproperty double p [readonli]\nend\n", false}},
      sources, report);
  const Model model = resolve(program, sources, report);
  check(model, report);
  EXPECT_FALSE(report.has_errors());
  ASSERT_EQ(report.sorted().size(), 1U);
  EXPECT_EQ(report.sorted().front()->code(), Code::R0610);
}

TEST(Check, RepeatedAndContradictingModifiersAreWarnings) {
  const Compiled result = compiled_lines(
      "object O\nproperty double a [nolockread, nolock]\nproperty double b [urgent, urgent]\n"
      "wire double c [readonly, writeonly]\nend\n");
  EXPECT_THAT(result.codes(), ElementsAre("R0611", "R0611", "R0611"));
  EXPECT_EQ(result.marked(0), "nolockread");
}

TEST(Check, FeaturesNeedTheirVersionOnlyWhereOneIsDeclared) {
  const std::string lines = "constant int32 A 1\nenum E\na = 1\nend enum\n";
  EXPECT_THAT(compiled({"service a.x\n" + lines}).codes(), IsEmpty());
  const Compiled old = compiled({"service a.x\noption version 0.8\n" + lines});
  EXPECT_THAT(old.codes(), testing::Contains("R0208").Times(2));
}

TEST(Check, AllMissingMembersOfOneObjectAreOneFinding) {
  const Compiled result = compiled_lines(
      "object A\nproperty double a\nfunction void f(int32 x)\nwire double w [readonly]\nend\n"
      "object B\nimplements A\nproperty double a\nend\n");
  EXPECT_THAT(result.codes(), ElementsAre("R0609"));
  EXPECT_EQ(message(result), "object `B` does not repeat `f` and `w` of `A`");
  EXPECT_THAT(result.report->sorted()[0]->helps(),
              ElementsAre("add `function void f(int32 x)`", "add `wire double w [readonly]`"));
}

TEST(Check, AMemberThatDiffersIsMarkedWhereItDiffers) {
  const Compiled result = compiled_lines(
      "object A\nfunction void f(int32 x, double y)\nend\n"
      "object B\nimplements A\nfunction void f(int32 x, single y)\nend\n");
  EXPECT_THAT(result.codes(), ElementsAre("R0609"));
  EXPECT_EQ(result.marked(0), "single");
  EXPECT_EQ(result.help(0), "write `function void f(int32 x, double y)`");
}

TEST(Check, AliasesAreExpandedBeforeMembersAreCompared) {
  const Compiled result = compiled(
      {"service a.x\nstdver 0.10\nimport b.x\nusing b.x.S as T\n"
       "object O\nimplements b.x.P\nproperty T s\nend\n",
       "service b.x\nstdver 0.10\nstruct S\nfield double x\nend\nobject P\nproperty S s\nend\n"});
  EXPECT_THAT(result.codes(), IsEmpty());
}

TEST(Check, AnImplementsCycleIsFoundWhereverItIs) {
  const Compiled result = compiled_lines(
      "object C\nimplements A\nend\nobject A\nimplements B\nend\nobject B\nimplements A\nend\n");
  EXPECT_THAT(result.codes(), ElementsAre("R0607"));
}

TEST(Check, ObjectsImplementedIndirectlyAreListed) {
  const Compiled result = compiled_lines(
      "object A\nevent e()\nend\nobject B\nimplements A\nevent e()\nend\nobject C\nimplements "
      "B\nevent e()\nend\n");
  EXPECT_THAT(result.codes(), ElementsAre("R0608"));
  EXPECT_EQ(result.help(0), "add `implements A`");
}

TEST(Check, TheStrictCheckWantsAVersion) {
  const auto strict = [](const std::string& text) {
    const Compiled result = compiled({text});
    check_strictly(result.model, *result.report);
    return result.errors();
  };
  EXPECT_THAT(strict("service a.x\nstdver 0.9.2\n"), IsEmpty());
  EXPECT_THAT(strict("service a.x\noption version 0.9.2\n"), IsEmpty());
  EXPECT_THAT(strict("service a.x\nstdver 0.9.1\n"), ElementsAre("R0135"));
  EXPECT_THAT(strict("service a.x\n"), ElementsAre("R0135"));
}

}  // namespace
}  // namespace robdef::model
