// SPDX-License-Identifier: Apache-2.0
#include "compiler/model/resolve.hpp"

#include <string>
#include <variant>

#include "compiler/model/compiled.hpp"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace robdef::model {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string base_file =
    "service example.base\nstdver 0.10\n"
    "constant int32 LIMIT 4\nexception Broken\n"
    "struct Point\nfield double x\nend\n"
    "object Device\nproperty double level\nend\n";

std::string user_file(const std::string& lines) {
  return "service example.t\nstdver 0.10\n" + lines;
}

TEST(Resolve, AliasAndFullNameAreOneType) {
  const Compiled result = compiled({user_file("import example.base\n"
                                              "using example.base.Point as Place\n"
                                              "object O\nproperty Place a\n"
                                              "property example.base.Point b\nend\n"),
                                    base_file});
  EXPECT_THAT(result.codes(), IsEmpty());
  const Record* point = &result.record("Point");
  EXPECT_EQ(std::get<const Record*>(result.member("O", "a").type.base), point);
  EXPECT_EQ(std::get<const Record*>(result.member("O", "b").type.base), point);
  EXPECT_EQ(result.member("O", "a").type.text(), "example.base.Point");
}

TEST(Resolve, ATypeMayBeUsedBeforeItIsDeclared) {
  const Compiled result =
      compiled_lines("object O\nproperty Late[]{list} a\nend\npod Late\nfield double x\nend\n");
  EXPECT_THAT(result.codes(), IsEmpty());
  EXPECT_EQ(result.member("O", "a").type.text(), "example.t.Late[]{list}");
}

TEST(Resolve, TheModelKeepsTheExactTextOfTheFile) {
  const std::string text = "\xEF\xBB\xBF# comment\r\nservice example.t\r\n";
  EXPECT_EQ(compiled({text}).definition(0).text, text);
}

TEST(Resolve, AnUnknownTypeIsReportedOnceAndLaterPassesAreSilent) {
  const Compiled result = compiled_lines(
      "struct Angles\nfield double x\nend\n"
      "pod P\nfield Angle a\nend\n"
      "object O\nmemory Angel m\nend\n");
  EXPECT_THAT(result.codes(), ElementsAre("R0203", "R0203"));
  EXPECT_EQ(result.marked(0), "Angle");
  EXPECT_EQ(result.help(0), "`Angles`, declared on line 3, is close");
  EXPECT_TRUE(std::holds_alternative<Unknown>(result.member("O", "m").type.base));
}

TEST(Resolve, WordsOfOtherLanguagesAreTranslated) {
  const Compiled result = compiled_lines("object O\nproperty float a\nproperty int b\nend\n");
  EXPECT_THAT(result.codes(), ElementsAre("R0203", "R0203"));
  EXPECT_EQ(result.help(0), "write `single`");
  EXPECT_EQ(result.help(1), "write `int32`");
}

TEST(Resolve, AnImportedTypeWithoutItsServiceIsPointedOut) {
  const Compiled result =
      compiled({user_file("import example.base\nobject O\nproperty Point a\nend\n"), base_file});
  EXPECT_THAT(result.codes(), ElementsAre("R0203"));
  EXPECT_EQ(result.help(0), "write `example.base.Point`, or add `using example.base.Point`");
}

TEST(Resolve, AnOwnTypeIsNotWrittenWithTheService) {
  const Compiled result =
      compiled_lines("struct S\nfield double x\nend\nobject O\nproperty example.t.S a\nend\n");
  EXPECT_THAT(result.codes(), ElementsAre("R0203"));
  EXPECT_EQ(result.help(0), "write `S`");
}

TEST(Resolve, ImportsAreNotPassedOn) {
  const Compiled result =
      compiled({user_file("import example.mid\nobject O\nproperty example.base.Point a\nend\n"),
                "service example.mid\nstdver 0.10\nimport example.base\n", base_file});
  EXPECT_THAT(result.codes(), ElementsAre("R0203"));
  EXPECT_EQ(result.help(0), "add `import example.base`");
  EXPECT_EQ(result.report->sorted()[0]->notes().front(),
            "`example.mid` imports it, but imports are not passed on");
}

TEST(Resolve, AMissingImportSilencesEverythingThatNeedsIt) {
  const Compiled result =
      compiled({user_file("import example.nothere\n"
                          "using example.nothere.A\n"
                          "object O\nproperty A a\n"
                          "property example.nothere.B b\n"
                          "objref example.nothere.C c\nend\n")});
  EXPECT_THAT(result.codes(), ElementsAre("R0505"));
  EXPECT_EQ(result.marked(0), "example.nothere");
}

TEST(Resolve, HelpForAMissingImportDoesNotNameTheFileItself) {
  EXPECT_EQ(compiled({"service example.mount\nimport example.mounts\n"}).help(0),
            "name the file of the definition, or the folder of `example.mounts.robdef` with -I");
}

TEST(Resolve, AnUnknownAliasIsReportedAtTheUsingLineOnly) {
  const Compiled result = compiled(
      {user_file("import example.base\nusing example.base.Pont\nobject O\nproperty Pont a\nend\n"),
       base_file});
  EXPECT_THAT(result.codes(), ElementsAre("R0508"));
  EXPECT_EQ(result.marked(0), "Pont");
  EXPECT_EQ(result.help(0), "`Point` is close");
}

TEST(Resolve, ALineThatCannotBeParsedSilencesTheNameItWouldHaveDeclared) {
  const Compiled result =
      compiled_lines("struct Good Better\nfield double x\nend\nobject O\nproperty Good a\nend\n");
  for (const std::string& code : result.codes()) EXPECT_THAT(code, HasSubstr("R01"));
  EXPECT_THAT(result.codes(), testing::SizeIs(1));
}

TEST(Resolve, AnExceptionIsNoType) {
  const Compiled result = compiled_lines("exception Ex\nobject O\nproperty Ex a\nend\n");
  EXPECT_THAT(result.codes(), ElementsAre("R0203"));
  EXPECT_EQ(result.report->sorted()[0]->message(), "`Ex` is an exception, not a type");
}

TEST(Resolve, CyclesOfImportsAreReportedOnce) {
  const Compiled result =
      compiled({"service a.x\nstdver 0.10\nimport b.x\n", "service b.x\nstdver 0.10\nimport c.x\n",
                "service c.x\nstdver 0.10\nimport b.x\n"});
  EXPECT_THAT(result.codes(), ElementsAre("R0506"));
  EXPECT_EQ(result.marked(0), "c.x");
}

TEST(Resolve, AVersionedFileImportsOnlyVersionsUpToItsOwn) {
  const Compiled result = compiled({"service a.x\nstdver 0.9.2\nimport b.x\nimport c.x\n",
                                    "service b.x\nstdver 0.10\n", "service c.x\n"});
  EXPECT_THAT(result.codes(), ElementsAre("R0507", "R0507"));
  EXPECT_EQ(result.help(0), "write `stdver 0.10`");
}

TEST(Resolve, GeneratorsAreTakenApart) {
  const Compiled result = compiled_lines(
      "object O\n"
      "function double{generator} a(int32 n)\n"
      "function void b(int32 n, uint8[]{generator} data)\n"
      "function string{generator} c(string{generator} words)\n"
      "function void d()\nend\n");
  EXPECT_THAT(result.codes(), IsEmpty());
  EXPECT_EQ(result.member("O", "a").generator, GeneratorForm::returns);
  EXPECT_EQ(result.member("O", "a").type.text(), "double");
  const Member& b = result.member("O", "b");
  EXPECT_EQ(b.generator, GeneratorForm::takes);
  ASSERT_EQ(b.parameters.size(), 1u);
  ASSERT_TRUE(b.generator_parameter.has_value());
  EXPECT_EQ(b.generator_parameter->name, "data");
  EXPECT_EQ(b.generator_parameter->type.text(), "uint8[]");
  EXPECT_EQ(result.member("O", "c").generator, GeneratorForm::both);
  EXPECT_EQ(result.member("O", "d").generator, GeneratorForm::none);
}

TEST(Resolve, ObjrefsHaveAnIndexAndABareType) {
  const Compiled result = compiled_lines(
      "object Sub\nevent e()\nend\nobject O\nobjref Sub a\nobjref Sub[] b\nobjref Sub{int32} c\n"
      "objref varobject{string} d\nend\n");
  EXPECT_THAT(result.codes(), IsEmpty());
  EXPECT_EQ(result.member("O", "a").index, IndexForm::none);
  EXPECT_EQ(result.member("O", "b").index, IndexForm::int32);
  EXPECT_EQ(result.member("O", "b").type.text(), "example.t.Sub");
  EXPECT_EQ(result.member("O", "c").index, IndexForm::int32);
  EXPECT_EQ(result.member("O", "d").index, IndexForm::string);
  EXPECT_TRUE(std::holds_alternative<VarObject>(result.member("O", "d").type.base));
}

TEST(Resolve, ReadonlyAndNolockWin) {
  const Access access = access_of(MemberKind::property, {{"writeonly", {}, {}, {}},
                                                         {"readonly", {}, {}, {}},
                                                         {"nolockread", {}, {}, {}},
                                                         {"nolock", {}, {}, {}},
                                                         {"urgent", {"1"}, {}, {}}});
  EXPECT_TRUE(access.is_readonly);
  EXPECT_FALSE(access.is_writeonly);
  EXPECT_TRUE(access.is_nolock);
  EXPECT_FALSE(access.is_nolockread);
  EXPECT_FALSE(access.is_urgent);
}

TEST(Resolve, TheOldPipeOptionMeansUnreliable) {
  const Compiled result =
      compiled({"service a.x\nobject O\noption pipe fast unreliable\n"
                "pipe double fast\npipe double slow\nend object\n"});
  EXPECT_TRUE(result.member("O", "fast").access.is_unreliable);
  EXPECT_FALSE(result.member("O", "slow").access.is_unreliable);
}

TEST(Resolve, LengthZeroMeansNoLimitButInNamedarrays) {
  const Compiled result = compiled_lines(
      "namedarray N\nfield double[0] none\nfield double one\nend\n"
      "object O\nproperty double[0] a\nproperty double[0-] b\nend\n");
  EXPECT_EQ(result.member("O", "a").type.text(), "double[]");
  EXPECT_EQ(result.member("O", "b").type.text(), "double[]");
  EXPECT_EQ(result.record("N").fields[0].type.text(), "double[0]");
  EXPECT_EQ(result.record("N").number_count, 1u);
}

TEST(Resolve, AnObjectNamedTwiceByImplementsIsKeptOnce) {
  const Compiled result =
      compiled_lines("object A\nend\nobject B\nimplements A\nimplements A\nend\n");
  EXPECT_THAT(result.object("B").implements, ElementsAre(&result.object("A")));
}

TEST(Resolve, ThousandsOfDefinitionsThatImportEachOtherInAChainAreFine) {
  std::vector<std::string> texts;
  for (int i = 0; i < 2000; ++i) {
    texts.push_back("service a.s" + std::to_string(i) + "\nstdver 0.10\n" +
                    (i < 1999 ? "import a.s" + std::to_string(i + 1) + "\n" : ""));
  }
  EXPECT_THAT(compiled(texts).codes(), IsEmpty());
}

}  // namespace
}  // namespace robdef::model
