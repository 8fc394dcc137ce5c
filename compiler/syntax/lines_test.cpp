// SPDX-License-Identifier: Apache-2.0
#include "compiler/syntax/lines.hpp"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "compiler/diagnostics/render.hpp"

namespace robdef::syntax {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

struct Read {
  std::vector<std::string> texts;
  std::vector<std::string> documentations;
  std::string findings;
};

Read read(const std::string& text, bool is_in_block = false) {
  Sources sources;
  const SourceId id = sources.add("a", text);
  Report report;
  LineReader reader(sources[id], id, report);
  Read result;
  LogicalLine line;
  while (reader.next(is_in_block, line)) {
    result.texts.emplace_back(line.text());
    result.documentations.push_back(line.documentation());
  }
  result.findings = render(report, sources, Format::line);
  return result;
}

TEST(Lines, BlanksEmptyLinesAndCommentsAreGone) {
  EXPECT_THAT(read("  one \t\n\n \t \n# two\n   # three\n\tfour").texts,
              ElementsAre("one", "four"));
}

TEST(Lines, ATextWithoutLinesGivesNone) {
  EXPECT_THAT(read("").texts, IsEmpty());
  EXPECT_THAT(read("\n\n").texts, IsEmpty());
  EXPECT_THAT(read("\xEF\xBB\xBF").texts, IsEmpty());
}

TEST(Lines, EndInLfOrAnyNumberOfCrAndLf) {
  const Read result = read("one\r\ntwo\nthree\r\r\n");
  EXPECT_THAT(result.texts, ElementsAre("one", "two", "three"));
  EXPECT_EQ(result.findings, "");
}

TEST(Lines, ACarriageReturnInsideALineIsReportedOnce) {
  EXPECT_EQ(read("one\rtwo\rthree\n").findings,
            "a(1,4): error: R0103 [L3] a carriage return that does not end a line\n");
  EXPECT_EQ(read("one\r").findings,
            "a(1,4): error: R0103 [L3] a carriage return that does not end a line\n");
}

TEST(Lines, TheBackslashOfAContinuationBecomesOneBlank) {
  EXPECT_THAT(read("one\\\ntwo\\\r\n  # three\nfour").texts,
              ElementsAre("one two   # three", "four"));
}

TEST(Lines, ACommentIsNotContinued) {
  EXPECT_THAT(read("# one\\\ntwo\n").texts, ElementsAre("two"));
}

TEST(Lines, AContinuationIsNotTheLastLine) {
  const Read result = read("one\\\n");
  EXPECT_THAT(result.texts, ElementsAre("one"));
  EXPECT_EQ(result.findings, "a(1,4): error: R0104 [L4] a continuation on the last line\n");
  EXPECT_EQ(read("one\n\\").findings,
            "a(2,1): error: R0104 [L4] a continuation on the last line\n");
}

TEST(Lines, BadBytesAreReportedOnceALineAndReplaced) {
  const Read result = read("a \xC3\xA9\xC3\xA9z\x01 \xFF\nb\n");
  EXPECT_THAT(result.texts, ElementsAre("a xxxxz  x", "b"));
  EXPECT_EQ(result.findings, "a(1,3): error: R0101 [L1] a character that is not ASCII\n");
}

TEST(Lines, BadBytesOfCommentsAreReportedToo) {
  EXPECT_EQ(read(std::string("# a\0b\n", 6)).findings,
            "a(1,4): error: R0102 [L2] a NUL byte in the text\n");
  EXPECT_EQ(read("## \x7F\n").findings,
            "a(1,4): error: R0101 [L1] a control character, number 127 of ASCII\n");
}

TEST(Lines, DocumentationBelongsToTheNextStatement) {
  const Read result = read("## one\n##   two\n##three\nfirst\nsecond\n");
  EXPECT_THAT(result.documentations, ElementsAre("one\n  two\nthree", ""));
}

TEST(Lines, AnEmptyLineBeforeMoreDocumentationStartsItAnew) {
  EXPECT_THAT(read("## one\n\n## two\n\nfirst\n").documentations, ElementsAre("two"));
}

TEST(Lines, ACommentDiscardsDocumentation) {
  EXPECT_THAT(read("## one\n# two\nfirst\n## three\n# four\n## five\nsecond").documentations,
              ElementsAre("", "five"));
}

TEST(Lines, ThreeSignsAreDocumentationThatBeginsWithOne) {
  EXPECT_THAT(read("### one\nfirst").documentations, ElementsAre("# one"));
}

TEST(Lines, DocumentationIsContinuedInsideBlocksOnly) {
  EXPECT_THAT(read("## one \\\nfirst\n").texts, ElementsAre("first"));
  const Read result = read("## one \\\nfirst\nsecond\n", true);
  EXPECT_THAT(result.texts, ElementsAre("second"));
  EXPECT_THAT(result.documentations, ElementsAre("one  first"));
  EXPECT_EQ(result.findings,
            "a(1,8): warning: R0145 [Q22] documentation that swallows the next line\n");
}

// The place of each word of a text, through whatever was joined.
std::vector<std::string> places(const std::string& text) {
  Sources sources;
  const SourceId id = sources.add("a", text);
  Report report;
  LineReader reader(sources[id], id, report);
  LogicalLine line;
  std::vector<std::string> result;
  while (reader.next(false, line)) {
    for (std::size_t begin = line.text().find_first_not_of(' '); begin != std::string::npos;) {
      const std::size_t end = std::min(line.text().find(' ', begin), line.text().size());
      const Span span = line.span(begin, end);
      const Position place = sources[id].position(span.begin);
      result.push_back(sources[id].text().substr(span.begin, span.end - span.begin) + " " +
                       std::to_string(place.line) + ":" + std::to_string(place.column));
      begin = line.text().find_first_not_of(' ', end);
    }
  }
  return result;
}

TEST(Lines, PlacesAreThoseOfTheSource) {
  EXPECT_THAT(places("  a bb\n\tccc"), ElementsAre("a 1:3", "bb 1:5", "ccc 2:2"));
  EXPECT_THAT(places("\xEF\xBB\xBF a\r\n  b"), ElementsAre("a 1:2", "b 2:3"));
}

TEST(Lines, PlacesAreThoseOfTheSourceAfterContinuations) {
  EXPECT_THAT(places("  a \\\n    bb\\\r\ncc\\\n\\\n dd\nee"),
              ElementsAre("a 1:3", "bb 2:5", "cc 3:1", "dd 5:2", "ee 6:1"));
}

TEST(Lines, PlacesAreThoseOfTheSourceOnDamagedLines) {
  EXPECT_THAT(places("a \xC3\xB6 b \\\n c"),
              ElementsAre("a 1:1", "\xC3\xB6 1:3", "b 1:6", "c 2:2"));
}

TEST(Lines, ASpanAcrossAJointReachesFromOneLineIntoTheNext) {
  Sources sources;
  const SourceId id = sources.add("a", "one \\\n two");
  Report report;
  LineReader reader(sources[id], id, report);
  LogicalLine line;
  ASSERT_TRUE(reader.next(false, line));
  EXPECT_EQ(line.span(), (Span{id, 0, 10}));
  EXPECT_TRUE(line.is_joint(4));
  EXPECT_FALSE(line.is_joint(3));
  EXPECT_FALSE(line.is_joint(5));
}

}  // namespace
}  // namespace robdef::syntax
