// SPDX-License-Identifier: Apache-2.0
#include "compiler/format/format.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/diagnostics/golden_corpus.hpp"
#include "compiler/format/testing.hpp"

namespace robdef::format {
namespace {

using ::testing::ElementsAre;
using testing::Formatted;
using ::testing::IsEmpty;

std::string formatted(const std::string& text) {
  const Formatted read(text);
  EXPECT_EQ(testing::fault_of_formatting(read), "") << text;
  return read.result;
}

// A line in an object, formatted.
std::string member(const std::string& line) {
  const std::string head = "service a\n\nobject O\n";
  const std::string result = formatted(head + line + "\nend\n");
  EXPECT_TRUE(result.starts_with(head)) << result;
  EXPECT_TRUE(result.ends_with("\nend\n")) << result;
  return result.substr(head.size(), result.size() - head.size() - 5);
}

TEST(Format, GoldenFilesBecomeWhatStandsBesideThem) {
  const GoldenCorpus corpus(ROBDEF_FORMAT_GOLDEN_DIR);
  ASSERT_GE(corpus.inputs().size(), 4U);
  for (const auto& input : corpus.inputs()) {
    const std::string text = GoldenCorpus::read(input);
    EXPECT_EQ(corpus.difference(input, ".formatted", formatted(text)), "");
  }
}

// The indented lines behind a heading of the page.
std::string example_behind(const std::string& page, const std::string& heading) {
  std::string text;
  std::size_t begin = page.find(heading) + heading.size();
  while (page.compare(begin, 1, "\n") == 0 || page.compare(begin, 4, "    ") == 0) {
    const std::size_t end = page.find('\n', begin) + 1;
    text += end - begin > 4 ? page.substr(begin + 4, end - begin - 4) : "\n";
    begin = end;
  }
  return text.substr(1, text.size() - 2);
}

TEST(Format, TheExampleOfTheDocumentationIsTrue) {
  const std::string page = GoldenCorpus::read(ROBDEF_FORMAT_PAGE);
  const std::string before = example_behind(page, "\nBefore:\n");
  EXPECT_GT(before.size(), 100U);
  EXPECT_EQ(formatted(before), example_behind(page, "\nAfter:\n"));
}

TEST(Format, BlanksBetweenTokens) {
  EXPECT_EQ(member("  property\tdouble[2,3]{list}   x   [readonly ,  nolock]"),
            "    property double[2,3]{list} x [readonly,nolock]");
  EXPECT_EQ(member("function void  f (  double a ,int32[ ]  b )"),
            "function void  f (  double a ,int32[ ]  b )")
      << "no blank may stand in a type: the line is left alone";
  EXPECT_EQ(member("function void  f (  double a ,int32[]  b )"),
            "    function void f(double a, int32[] b)");
  EXPECT_EQ(member("event e( )"), "    event e()");
  EXPECT_EQ(member("wire a.b.C{string} w  [special(1 ,2.5,  LIMIT),urgent]"),
            "    wire a.b.C{string} w [special(1, 2.5, LIMIT),urgent]");
  EXPECT_EQ(member("constant  double[]  A  { 1,2 ,3 }"), "    constant double[] A {1, 2, 3}");
  EXPECT_EQ(member("constant struct P {x:A,y :B}"), "    constant struct P {x: A, y: B}");
  EXPECT_EQ(member("constant string  S \"a  \\\\ b\"  "), "    constant string S \"a  \\\\ b\"");
  EXPECT_EQ(member("implements   a.b.C"), "    implements a.b.C");
}

TEST(Format, ValuesOfEnumsStayOnTheirLines) {
  EXPECT_EQ(formatted("service a\n\nenum E\na=1,b\t=\t0x2 ,\n  c ,\nend\n"),
            "service a\n\nenum E\n    a = 1, b = 0x2,\n    c,\nend\n");
}

TEST(Format, OptionsKeepTheirText) {
  EXPECT_EQ(member("option   pipe  p   unreliable "), "    option pipe  p   unreliable");
}

TEST(Format, ContinuationsStayWhereTheyAre) {
  EXPECT_EQ(member("function void f(double a,\\\n double b, \\\n\tdouble c)"),
            "    function void f(double a, \\\n        double b, \\\n        double c)");
  EXPECT_EQ(formatted("service \\\na\n"), "service \\\n    a\n");
}

TEST(Format, AContinuationThatABlankWouldBreakStaysAsItIs) {
  EXPECT_EQ(formatted("service a\n\nusing  b.C as\\\nD\n"), "service a\n\nusing  b.C as\\\nD\n");
}

TEST(Format, AStringIsNeverTouched) {
  EXPECT_EQ(member("constant string S \"a,b  {c\\\n  d\""),
            "    constant string S \"a,b  {c\\\n  d\"");
}

TEST(Format, BlankLinesBetweenSectionsAndBlocks) {
  EXPECT_EQ(formatted("\n\nservice a\nstdver 0.10\nimport b\n\n\nimport c\nusing b.D\n"
                      "# of S\nstruct S\n\n\nfield D x\n\n\nfield D y\n\nend\nstruct T\nend\n\n\n"),
            "service a\n\nstdver 0.10\n\nimport b\n\nimport c\n\nusing b.D\n\n"
            "# of S\nstruct S\n    field D x\n\n    field D y\nend\n\nstruct T\nend\n");
}

TEST(Format, CommentsMoveWithTheirBlockAndKeepTheirText) {
  EXPECT_EQ(
      formatted("service a\n\n  #one  \n\n ##  two\nobject O\n#three\n\t## four\nend\n# five"),
      "service a\n\n#one\n\n##  two\nobject O\n    #three\n    ## four\nend\n# five\n");
}

TEST(Format, ABackslashBehindACommentIsNotMadeAContinuation) {
  EXPECT_EQ(member("## doc \\ \nproperty double x"), "    ## doc \\ \n    property double x");
}

TEST(Format, LineEndsOfTheFileAreKept) {
  EXPECT_EQ(formatted("service a\r\nimport b  \r\n\r\n\r\nimport c"),
            "service a\r\n\r\nimport b\r\n\r\nimport c\r\n");
  EXPECT_EQ(formatted("service a\nimport b\r\nusing b.C\n"),
            "service a\n\nimport b\r\n\r\nusing b.C\n")
      << "a line that is added ends as the one above it";
}

TEST(Format, AByteOrderMarkAndBytesBeyondAsciiAreKept) {
  EXPECT_EQ(formatted("\xEF\xBB\xBFservice  a\n"), "\xEF\xBB\xBFservice a\n");
  EXPECT_EQ(member("# gr\xC3\xB6\xC3\x9F"
                   "e\nproperty  double x"),
            "    # gr\xC3\xB6\xC3\x9F"
            "e\n    property double x")
      << "an error of the comment, which moves nevertheless";
  EXPECT_EQ(member("property  double gr\xC3\xB6"), "property  double gr\xC3\xB6")
      << "a statement that cannot be read stays";
}

TEST(Format, LinesThatCannotBeReadStayAsTheyAre) {
  const std::string text =
      "service a\n\nstruct S\n  field  double\n    field double x\n  message  Foo {\n\n\n"
      "\tproperty double y\nend\n";
  EXPECT_EQ(formatted(text),
            "service a\n\nstruct S\n  field  double\n    field double x\n  message  Foo {\n\n"
            "\tproperty double y\nend\n");
}

TEST(Format, ACommentStaysWithALineThatCannotBeRead) {
  EXPECT_EQ(member("property  double x\n  # of y\n  property  y"),
            "    property double x\n  # of y\n  property  y");
}

TEST(Format, ACarriageReturnInsideOfACommentIsNotMadeALineEnd) {
  EXPECT_EQ(member("# a\r \nproperty double x"), "    # a\r \n    property double x");
}

TEST(Format, ACarriageReturnAtTheEndOfTheFileIsNotMadeALineEnd) {
  EXPECT_EQ(formatted("service a\r\n# b\r"), "service a\r\n# b\r");
}

TEST(Format, BlanksBehindACommentGoInALineWithoutEnd) {
  EXPECT_EQ(formatted("service a\n# b  "), "service a\n# b\n");
}

TEST(Format, BytesBelowBlankLinesAreNotMadeAByteOrderMark) {
  EXPECT_EQ(formatted("\n\n\xEF\xBB\xBF# a\nservice a\n"), "\n\n\xEF\xBB\xBF# a\nservice a\n");
}

TEST(Format, ABlockWithoutEndDoesNotIndentTheNextOne) {
  EXPECT_EQ(formatted("service a\n\nstruct S\nfield double x\n\n# of T\nstruct T\nfield double y\n"
                      "end\n"),
            "service a\n\nstruct S\n    field double x\n\n# of T\nstruct T\n    field double y\n"
            "end\n");
}

TEST(Format, NothingIsAddedToAnEmptyFile) {
  EXPECT_EQ(formatted(""), "");
  EXPECT_EQ(formatted("  \n\n"), "");
}

TEST(Format, EditsNameTheirPlaceAndReason) {
  const std::string text = "service a\nstdver  0.10 ";
  const Formatted read(text);
  std::vector<std::string> found;
  for (const Edit& edit : edits(read.file.written, text)) {
    found.push_back(std::to_string(edit.begin) + ' ' + std::string(text_of(edit.reason)));
  }
  EXPECT_THAT(found, ElementsAre("10 blank line missing above", "16 blanks between words",
                                 "22 blanks at the end of the line",
                                 "23 line end missing at the end of the file"));
  const Formatted again(read.result);
  EXPECT_THAT(edits(again.file.written, again.text), IsEmpty());
}

}  // namespace
}  // namespace robdef::format
