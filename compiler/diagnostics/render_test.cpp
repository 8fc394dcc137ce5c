// SPDX-License-Identifier: Apache-2.0
#include "compiler/diagnostics/render.hpp"

#include <gmock/gmock.h>

#include <string>

namespace robdef {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// A source of one file and the span of a piece of it.
class RenderTest : public ::testing::Test {
 protected:
  SourceId add(const std::string& name, const std::string& text) {
    return sources_.add(name, text);
  }

  [[nodiscard]] Span span_of(SourceId id, std::string_view piece) const {
    const auto begin = static_cast<std::uint32_t>(sources_[id].text().find(piece));
    return {id, begin, begin + static_cast<std::uint32_t>(piece.size())};
  }

  [[nodiscard]] std::string text() const { return render(report_, sources_, Format::text); }

  Sources sources_;
  Report report_;
};

TEST_F(RenderTest, TextHasTheLineWithCaretsAndHelp) {
  const SourceId id =
      add("mount.robdef", std::string(11, '\n') + "    function void aim(Angle target)\nend\n");
  report_.add(Code::R0203, span_of(id, "Angle"), "unknown type `Angle`")
      .label("no struct, pod, namedarray or enum has this name")
      .help("`Angles`, declared on line 7, is close")
      .note("names are case sensitive");
  EXPECT_EQ(text(),
            "error[R0203]: unknown type `Angle`\n"
            "  --> mount.robdef:12:23\n"
            "   |\n"
            "12 |     function void aim(Angle target)\n"
            "   |                       ^^^^^ no struct, pod, namedarray or enum has this name\n"
            "   = help: `Angles`, declared on line 7, is close\n"
            "   = note: names are case sensitive\n");
}

TEST_F(RenderTest, ASecondPlaceIsShownInTheOrderOfLines) {
  const SourceId id = add("a.robdef", "service a\nstruct S\nend\n\npod S\nend\n");
  report_.add(Code::R0204, {id, 28, 29}, "`S` is declared twice")
      .label("again here")
      .also({id, 17, 18}, "first declared here");
  EXPECT_EQ(text(),
            "error[R0204]: `S` is declared twice\n"
            " --> a.robdef:5:5\n"
            "  |\n"
            "2 | struct S\n"
            "  |        - first declared here\n"
            "...\n"
            "5 | pod S\n"
            "  |     ^ again here\n");
}

TEST_F(RenderTest, TwoPlacesOnOneLineShareIt) {
  const SourceId id = add("a.robdef", "function void f(int32 a, int32 a)\n");
  report_.add(Code::R0602, {id, 31, 32}, "`a` occurs twice").also({id, 22, 23}, "first here");
  EXPECT_THAT(text(), HasSubstr("1 | function void f(int32 a, int32 a)\n"
                                "  |                       - first here\n"
                                "  |                                ^\n"));
}

TEST_F(RenderTest, APlaceInAnotherFileHasItsName) {
  const SourceId one = add("one.robdef", "service one\n");
  const SourceId two = add("two.robdef", "\nservice one\n");
  report_.add(Code::R0511, span_of(two, "one"), "`one` is defined twice")
      .also(span_of(one, "one"), "first defined here");
  EXPECT_EQ(text(),
            "error[R0511]: `one` is defined twice\n"
            " --> two.robdef:2:9\n"
            "  |\n"
            "2 | service one\n"
            "  |         ^^^\n"
            " ::: one.robdef:1:9\n"
            "  |\n"
            "1 | service one\n"
            "  |         --- first defined here\n");
}

TEST_F(RenderTest, TabsTakeOneColumnAndLettersBeyondAsciiToo) {
  const SourceId id = add("a",
                          "\tstruct Gr\xC3\xB6\xC3\x9F"
                          "e x\n");
  report_.add(Code::R0101, span_of(id, "\xC3\xB6\xC3\x9F"), "bad");
  report_.add(Code::R0118, span_of(id, "x"), "unexpected");
  EXPECT_THAT(text(), HasSubstr("1 |  struct Gr\xC3\xB6\xC3\x9F"
                                "e x\n  |           ^^\n"));
  EXPECT_THAT(text(), HasSubstr("e x\n  |               ^\n"));
}

TEST_F(RenderTest, BytesThatAreNoTextAreShownAsQuestionMarks) {
  const SourceId id = add("a", std::string("# \xFF\xC3 \0 \x7F\x01z\n", 11));
  report_.add(Code::R0101, {id, 2, 3}, "bad");
  EXPECT_THAT(text(), HasSubstr("1 | # ??     z\n  |   ^\n"));
}

TEST_F(RenderTest, LongLinesAreCutAroundThePlace) {
  const std::string filler(1'000'000, 'x');
  const SourceId id = add("a", filler + "HERE" + filler);
  report_.add(Code::R0107, span_of(id, "HERE"), "unknown");
  EXPECT_LT(text().size(), 600U);
  EXPECT_THAT(text(), HasSubstr(":1:1000001\n"));
  EXPECT_THAT(text(), HasSubstr("1 | ..." + std::string(60, 'x') + "HERExxx"));
  EXPECT_THAT(text(), HasSubstr("\n  | " + std::string(63, ' ') + "^^^^\n"));
}

TEST_F(RenderTest, ASpanOverALineEndIsMarkedToTheEndOfItsLine) {
  const SourceId id = add("a", "one two\nthree\n");
  report_.add(Code::R0107, {id, 4, 13}, "spread");
  EXPECT_THAT(text(), HasSubstr("1 | one two\n  |     ^^^\n"));
  EXPECT_THAT(text(), Not(HasSubstr("three")));
}

TEST_F(RenderTest, APlaceBehindTheLastCharacterHasOneCaret) {
  const SourceId id = add("a", "end");
  report_.add(Code::R0107, {id, 3, 3}, "more wanted");
  EXPECT_THAT(text(), HasSubstr("1 | end\n  |    ^\n"));
}

TEST_F(RenderTest, AFileThatCannotBeOpenedHasNoExcerpt) {
  const SourceId id = add("gone.robdef", "");
  report_.add(Code::R0509, {id, 0, 0}, "`gone.robdef` is not there").help("check the path");
  EXPECT_EQ(text(),
            "error[R0509]: `gone.robdef` is not there\n"
            " --> gone.robdef:1:1\n"
            "  = help: check the path\n");
}

TEST_F(RenderTest, TheOneLineFormNamesFileLineColumnCodeAndRule) {
  const SourceId id = add("a.robdef", "x\n  Nope y\n");
  report_.add(Code::R0203, span_of(id, "Nope"), "unknown type `Nope`").help("not shown");
  report_.add(Code::R0509, {id, 0, 0}, "no rule");
  report_.add(Code::R0136, {id, 0, 1}, "old");
  EXPECT_EQ(render(report_, sources_, Format::line),
            "a.robdef(1,1): error: R0509 no rule\n"
            "a.robdef(1,1): warning: R0136 [W4] old\n"
            "a.robdef(2,3): error: R0203 [V12] unknown type `Nope`\n");
}

TEST_F(RenderTest, JsonHoldsEverything) {
  const SourceId id = add("a \"b\".robdef", "x\n  Nope y\n");
  report_.add(Code::R0203, span_of(id, "Nope"), "unknown `Nope`")
      .label("label")
      .also({id, 0, 1}, "other")
      .help("h")
      .note("n");
  EXPECT_EQ(render(report_, sources_, Format::json), R"([
  {
    "code": "R0203",
    "rule": "V12",
    "severity": "error",
    "message": "unknown `Nope`",
    "file": "a \"b\".robdef",
    "line": 2,
    "column": 3,
    "end": {
      "line": 2,
      "column": 7
    },
    "labels": [
      {
        "file": "a \"b\".robdef",
        "line": 2,
        "column": 3,
        "end": {
          "line": 2,
          "column": 7
        },
        "text": "label"
      },
      {
        "file": "a \"b\".robdef",
        "line": 1,
        "column": 1,
        "end": {
          "line": 1,
          "column": 2
        },
        "text": "other"
      }
    ],
    "help": [
      "h"
    ],
    "notes": [
      "n"
    ]
  }
]
)");
}

TEST_F(RenderTest, NothingFoundIsNoTextAndAnEmptyArray) {
  EXPECT_EQ(text(), "");
  EXPECT_EQ(render(report_, sources_, Format::line), "");
  EXPECT_EQ(render(report_, sources_, Format::json), "[]\n");
}

TEST_F(RenderTest, FindingsAreSetApartByAnEmptyLine) {
  const SourceId id = add("a", "x y\n");
  report_.add(Code::R0107, {id, 0, 1}, "one");
  report_.add(Code::R0107, {id, 2, 3}, "two");
  EXPECT_THAT(text(), HasSubstr("^\n\nerror[R0107]: two\n"));
}

}  // namespace
}  // namespace robdef
