// SPDX-License-Identifier: Apache-2.0
#include "compiler/breaking/compare.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ctime>

#include "compiler/breaking/testing.hpp"
#include "compiler/diagnostics/render.hpp"

namespace robdef::breaking {
namespace {

using testing::Compared;
using testing::definition;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::with_root;

std::string codes(const std::string& before, const std::string& now, Wanted wanted = {}) {
  const Compared compared({before}, {now}, std::move(wanted));
  EXPECT_FALSE(compared.report.has_errors())
      << render(compared.report, compared.sources, Format::text);
  return compared.codes();
}

std::string body_codes(const std::string& before, const std::string& now) {
  return codes(definition(before), definition(now));
}

std::string member_codes(const std::string& before, const std::string& now) {
  return codes(with_root("", before), with_root("", now));
}

std::vector<std::string> messages(const std::string& before, const std::string& now) {
  const Compared compared({before}, {now});
  std::vector<std::string> result;
  for (const Change& change : compared.changes.list()) {
    result.push_back(change.diagnostic.message());
  }
  return result;
}

constexpr const char* rich = R"(exception Jam
constant int32 HOME 1
constant string NAME "a"
constant struct BOTH {a: HOME, b: NAME}
enum Mode
    idle = 0,
    busy = 0x1
end
struct Note
    field string text
    field Mode{list} modes
    field Note{list} more
end
pod Sample
    field double[3] at
    field Vector3 v
end
namedarray Vector3
    field double x
    field double y
end
object Base
    property double p
end
object Root
    constant int16 ROUNDS 3
    implements Base
    property double p
    property Note note [readonly,nolock]
    function double{generator} scan(double from, Sample{generator} more)
    event changed(Mode mode, Vector3 at)
    objref Base{string} bases
    pipe Sample[] samples [unreliable]
    callback Note ask(string what)
    wire Vector3 force [readonly]
    memory double[*] grid
end)";

TEST(Breaking, ADefinitionDoesNotBreakItself) {
  EXPECT_EQ(body_codes(rich, rich), "");
  EXPECT_EQ(codes("service x.t\nobject Root\nend", "service x.t\nobject Root\nend"), "");
}

TEST(Breaking, OrderCommentsAndBlanksAreNoChange) {
  EXPECT_EQ(body_codes("struct A\nfield double x\nend\npod B\nfield double x\nend\nobject O\n"
                       "property double p\nfunction void f(double a, double b)\nend",
                       "## Documented.\n\nobject  O\n  # a comment\n"
                       "function  void f( double a ,double b )\n\n## What it is.\n"
                       "property double p\nend\npod B\nfield double x\nend\nstruct A\n"
                       "field double x\nend"),
            "");
  EXPECT_EQ(body_codes("enum E\na = 0,\nb = 16\nend", "enum E\nb = 0x10,\na = 0\nend"), "");
  EXPECT_EQ(body_codes("constant int32 A 16\nconstant int32 B 1",
                       "constant int32 B 1\n"
                       "constant int32 A 0x10"),
            "");
}

TEST(Breaking, WhatIsNewBreaksNobody) {
  EXPECT_EQ(body_codes("object Root\nproperty double p\nend",
                       "exception Jam\nconstant int32 A 1\nenum E\na = 0\nend\n"
                       "struct S\nfield double x\nend\nobject Other\nend\nobject Root\n"
                       "constant int32 B 1\n"
                       "property double p\nproperty double q\nfunction void f(S s)\nevent e()\n"
                       "objref Other o\npipe double pp\ncallback void c()\nwire double w\n"
                       "memory double[] m\nend"),
            "");
  EXPECT_EQ(body_codes("enum E\na = 0\nend", "enum E\na = 0,\nb = 1\nend"), "");
  EXPECT_EQ(body_codes("struct S\nconstant int32 A 1\nfield double x\nend",
                       "struct S\nconstant int32 A 1\nconstant int32 B 1\nfield double x\nend"),
            "");
}

TEST(Breaking, MorePossibilitiesAndWordsWithoutEffectBreakNobody) {
  EXPECT_EQ(member_codes("property double p [readonly]", "property double p"), "");
  EXPECT_EQ(member_codes("wire double p [writeonly]", "wire double p"), "");
  EXPECT_EQ(member_codes("property double p", "property double p [urgent]"), "");
  EXPECT_EQ(member_codes("function void f() [nolock,urgent]", "function void f() [urgent,nolock]"),
            "");
  EXPECT_EQ(member_codes("property double p [readonly]", "property double p [readonly,writeonly]"),
            "")
      << "readonly wins";
  EXPECT_EQ(codes(with_root("object Leaf\nend", "objref Leaf[] o"),
                  with_root("object Leaf\nend", "objref Leaf{int32} o")),
            "")
      << "two spellings of one thing";
  EXPECT_EQ(codes("service x.t\nstdver 0.10\n", "service x.t\nstdver 0.9\n"), "")
      << "an earlier version";
}

TEST(Breaking, AnAliasIsItsType) {
  const std::string types = "service x.types\nstdver 0.10\nstruct S\nfield double x\nend\n";
  const Compared compared(
      {"service x.t\nstdver 0.10\nimport x.types\nobject O\nproperty x.types.S p\nend\n", types},
      {"service x.t\nstdver 0.10\nimport x.types\nusing x.types.S as T\nobject O\n"
       "property T p\nend\n",
       types});
  EXPECT_EQ(compared.codes(), "");
}

TEST(Breaking, AChangedTypeIsReportedWhereItIsDeclaredAndNowhereElse) {
  const std::string members = "property T p\nfunction T f(T a)\nwire T w";
  EXPECT_EQ(codes(with_root("struct T\nfield double x\nend", members),
                  with_root("struct T\nfield double x\nfield double y\nend", members)),
            "R0710");
  EXPECT_EQ(codes(with_root("namedarray In\nfield double x\nend\nnamedarray T\nfield In a\n"
                            "field In b\nend",
                            "property T p"),
                  with_root("namedarray In\nfield double x\nfield double y\nend\nnamedarray T\n"
                            "field In a\nfield In b\nend",
                            "property T p")),
            "R0713");
}

TEST(Breaking, ARenamedTypeIsReportedOnce) {
  EXPECT_EQ(codes(with_root("struct T\nfield double x\nend", "property T p\nfunction T f(T a)"),
                  with_root("struct U\nfield double x\nend", "property U p\nfunction U f(U a)")),
            "R0715");
  EXPECT_THAT(messages(definition("object Arm\nproperty double p\nend"),
                       definition("object Leg\nproperty double p\nend")),
              ElementsAre("object `Arm` is now called `Leg`"));
}

TEST(Breaking, ARenameIsOnlyGuessedWhereThereIsOneOfALook) {
  EXPECT_THAT(messages(with_root("", "property double a\nproperty double b"),
                       with_root("", "property double c\nproperty int32 d")),
              ElementsAre("property `Root.a` is gone", "property `Root.b` is gone"));
  EXPECT_THAT(
      messages(with_root("", "property double a\nproperty int32 b"),
               with_root("", "property double c\nproperty int32 d")),
      ElementsAre("property `Root.a` is now called `c`", "property `Root.b` is now called `d`"));
}

TEST(Breaking, SeveralServicesThatAreGoneAreEachNamed) {
  const Compared compared({"service x.a\nstdver 0.10\n", "service x.b\nstdver 0.10\n"},
                          {"service x.c\nstdver 0.10\n"});
  EXPECT_EQ(compared.codes(), "R0701 R0701");
  EXPECT_EQ(compared.changes.list()[0].new_place, std::nullopt);
}

TEST(Breaking, WhatIsInARenamedServiceIsComparedToo) {
  EXPECT_EQ(codes("service x.a\nstdver 0.10\nobject O\nproperty double p\nend\n",
                  "service x.b\nstdver 0.10\nobject O\nproperty single p\nend\n"),
            "R0701 R0705");
}

TEST(Breaking, AConstantOfStructsIsComparedByItsParts) {
  const std::string parts = "constant int32 A 1\nconstant int32 B 1\n";
  EXPECT_EQ(body_codes(parts + "constant struct S {x: A, y: B}",
                       parts + "constant struct S {y: B, x: A}"),
            "");
  EXPECT_EQ(body_codes(parts + "constant struct S {x: A, y: B}",
                       parts + "constant struct S {x: B, y: B}"),
            "R0773");
  EXPECT_EQ(body_codes("constant double[] A {1.0, 2}", "constant double[] A {1, 2.0}"), "");
  EXPECT_EQ(body_codes("constant double[] A {1, 2}", "constant double[] A {1, 2, 3}"), "R0773");
  EXPECT_EQ(body_codes("constant string A \"a\"", "constant string A \"b\""), "R0773");
  EXPECT_THAT(
      messages(definition("constant double A 1e-9\nconstant string B \"a\""),
               definition("constant double A 2e-9\nconstant string B \"b\"")),
      ElementsAre("constant `x.t.A` is 2e-09, it was 1e-09", "constant `x.t.B` has another value"));
  EXPECT_EQ(codes(with_root("", "constant int32 A 1"), with_root("", "constant int32 A 2")),
            "R0773");
}

TEST(Breaking, MembersOfImplementedObjectsHaveToBeRepeatedByOthers) {
  const std::string uses = "\nimplements Base\n";
  const auto set = [&](const std::string& members) {
    return definition("object Base\n" + members + "\nend\nobject O" + uses + members + "\nend");
  };
  EXPECT_EQ(codes(set("property double p"), set("property double p [urgent]")), "R0749");
  EXPECT_EQ(codes(set("property double p [readonly]"), set("property double p")), "R0749");
  EXPECT_EQ(codes(set("property double p"), set("property double p\nwire double w")), "R0749");
  const std::string other = "object Other\nend\n";
  EXPECT_EQ(body_codes(other + "object Base\nend\nobject O\nimplements Base\nend",
                       other + "object Base\nimplements Other\nend\nobject O\nimplements Base\n"
                               "implements Other\nend"),
            "R0749");
}

TEST(Breaking, LocksCountWhereTheyHaveAnEffect) {
  EXPECT_EQ(member_codes("property double p", "property double p [nolockread]"), "R0775");
  EXPECT_EQ(member_codes("property double p [nolockread]", "property double p [nolock]"), "R0775");
  EXPECT_EQ(member_codes("function void f()", "function void f() [nolockread]"), "")
      << "means nothing there";
}

TEST(Breaking, OnlyWhatIsWantedIsReported) {
  const std::string before =
      definition("constant int32 A 1\nenum E\na = 0\nend\nobject O\nproperty double p\nend");
  const std::string now =
      definition("constant int32 A 2\nenum E\nb = 0\nend\nobject O\nproperty single p\nend");
  EXPECT_EQ(codes(before, now), "R0705 R0742 R0773");
  EXPECT_EQ(codes(before, now, {{Category::wire}, {}}), "R0705");
  EXPECT_EQ(codes(before, now, {{Category::source}, {}}), "R0705 R0742");
  EXPECT_EQ(codes(before, now, {{Category::behaviour}, {}}), "R0773");
  EXPECT_EQ(codes(before, now, {Categories::all(), {Code::R0705, Code::R0773}}), "R0742");
}

TEST(Breaking, BothPlacesAreNamed) {
  const Compared compared({"service x.t\nstdver 0.10\nobject O\n    property double p\nend\n"},
                          {"service x.t\nstdver 0.10\n\nobject O\n    property single p\nend\n"});
  ASSERT_EQ(compared.changes.list().size(), 1U);
  EXPECT_EQ(to_text(compared.changes.list()[0].diagnostic, compared.sources),
            "error[R0705]: property `O.p` is `single`, it was `double`\n"
            " --> new.robdef:5:21\n"
            "  |\n"
            "5 |     property single p\n"
            "  |                     ^ new\n"
            " ::: old.robdef:4:21\n"
            "  |\n"
            "4 |     property double p\n"
            "  |                     - old\n"
            "  = help: add a member or field of the new type, and keep this one\n"
            "  = note: wire, source: the receiver refuses it with DataTypeMismatch\n");
}

TEST(Breaking, MoreThanAnybodyReadsIsCountedOnly) {
  std::string before;
  for (std::size_t i = 0; i < Changes::most + 5; ++i) {
    before += "property double p" + std::to_string(i) + "\n";
  }
  const Compared compared({with_root("", before)}, {with_root("", "")});
  EXPECT_EQ(compared.changes.list().size(), Changes::most);
  EXPECT_EQ(compared.changes.count(), Changes::most + 5);
}

// Texts that a peer may have made to keep its reader busy: each four times as large takes less than
// twelve times as long.
class Growth : public ::testing::TestWithParam<int> {
 protected:
  static std::string repeated(int count, const std::function<std::string(int)>& one) {
    std::string text;
    for (int i = 0; i < count; ++i) text += one(i);
    return text;
  }
  static std::string number(int i) { return std::to_string(i); }

  // Old and new text.
  static std::pair<std::string, std::string> texts(int kind, int n) {
    const auto fields = [n](const std::string& type, const std::string& name) {
      return repeated(n, [&](int i) { return "field " + type + " " + name + number(i) + "\n"; });
    };
    switch (kind) {
      case 0:  // everything gone, everything new
        return {definition("struct S\n" + fields("double", "a") + "end"),
                definition("struct S\n" + fields("double", "b") + "end")};
      case 1:  // types that look alike
        return {definition(repeated(
                    n, [](int i) { return "struct A" + number(i) + "\nfield double x\nend\n"; })),
                definition(repeated(
                    n, [](int i) { return "struct B" + number(i) + "\nfield double x\nend\n"; }))};
      case 2: {  // a long name in every message
        const std::string name = "N" + std::string(static_cast<std::size_t>(n) * 20, 'n');
        return {
            definition("object " + name + "\n" +
                       repeated(n, [](int i) { return "property double p" + number(i) + "\n"; }) +
                       "end"),
            definition("object " + name + "\n" +
                       repeated(n, [](int i) { return "property single p" + number(i) + "\n"; }) +
                       "end")};
      }
      case 3: {  // a long name of the service, in the name of every type
        const std::string service =
            "service x." + std::string(static_cast<std::size_t>(n) * 20, 's') + "\nstdver 0.10\n";
        const std::string body = repeated(n, [](int i) {
          return "struct S" + number(i) + "\nfield S" + number(i) + "{list} x\nend\n";
        });
        return {service + body, service + body + "struct More\nend\n"};
      }
      case 4:  // objects that implement each other's like
        return {definition("object B\nend\n" + repeated(n,
                                                        [](int i) {
                                                          return "object O" + number(i) +
                                                                 "\nimplements B\nend\n";
                                                        })),
                definition("object B\nproperty double p\nend\n" + repeated(n, [](int i) {
                             return "object O" + number(i) +
                                    "\nimplements B\nproperty double p\nend\n";
                           }))};
      case 5:  // namedarrays in namedarrays
        return {definition("namedarray A0\nfield double x\nend\n" +
                           repeated(n,
                                    [](int i) {
                                      return "namedarray A" + number(i + 1) + "\nfield A" +
                                             number(i) + " x\nend\n";
                                    })),
                definition("namedarray A0\nfield double[2] x\nend\n" + repeated(n, [](int i) {
                             return "namedarray A" + number(i + 1) + "\nfield A" + number(i) +
                                    " x\nend\n";
                           }))};
      default:  // parameters and values of an enum
        return {
            definition(
                "enum E\n" +
                repeated(n, [](int i) { return "a" + number(i) + " = " + number(i) + ",\n"; }) +
                "z = -1\nend\nobject O\nevent e(" +
                repeated(n, [](int i) { return "double a" + number(i) + ", "; }) +
                "double z)\nend"),
            definition(
                "enum E\n" +
                repeated(
                    n, [n](int i) { return "a" + number(n - 1 - i) + " = " + number(i) + ",\n"; }) +
                "z = -1\nend\nobject O\nevent e(" +
                repeated(n, [n](int i) { return "double a" + number(n - 1 - i) + ", "; }) +
                "double z)\nend")};
    }
  }

  // Reading is measured elsewhere, and takes longer.
  static double cost(int kind, int n) {
    const auto [before, now] = texts(kind, n);
    const testing::Models models({before}, {now});
    const std::clock_t begin = std::clock();
    Changes changes;
    compare(models.before, models.now, false, changes);
    return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  }
};

TEST_P(Growth, IsThatOfTheTexts) {
  constexpr double at_once = 0.1;
  double first = 0;
  double second = 0;
  for (int attempt = 0; attempt < 3; ++attempt) {
    first = cost(GetParam(), 2000);
    second = cost(GetParam(), 8000);
    if (second < std::max(12 * first, at_once)) break;
  }
  EXPECT_LT(second, std::max(12 * first, at_once)) << first << " s, then " << second << " s";
}

INSTANTIATE_TEST_SUITE_P(HostileTexts, Growth, ::testing::Range(0, 7));

}  // namespace
}  // namespace robdef::breaking
