// SPDX-License-Identifier: Apache-2.0
// The compiler enters the grammar line by line. Here the grammar is taken as a whole, by its first
// rule, as other tools may use it.
#include <RobdefLexer.h>
#include <RobdefParser.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <string_view>

#include "compiler/diagnostics/golden_corpus.hpp"
#include "compiler/diagnostics/mutations.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/syntax/parse.hpp"
#include "compiler/syntax/words.hpp"

namespace robdef::syntax {
namespace {

namespace fs = std::filesystem;

std::string trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return std::string(text);
}

// Continued lines joined, as README.md of the grammar says.
std::string joined(std::string_view line) {
  std::string text;
  for (const char c : line) {
    if (c != '\n') {
      text += c;
      continue;
    }
    while (text.ends_with('\r')) text.pop_back();
    if (text.ends_with('\\')) text.back() = ' ';
  }
  return trimmed(text);
}

// What the grammar cannot say of a line that fits it: whether numbers fit, and whether names, kinds
// of blocks and versions agree.
bool is_left_to_checks(Code code) {
  static const std::set<Code> codes = {
      Code::R0111, Code::R0112, Code::R0113, Code::R0114, Code::R0115, Code::R0120, Code::R0130,
      Code::R0131, Code::R0133, Code::R0134, Code::R0301, Code::R0302, Code::R0303, Code::R0304};
  return codes.contains(code);
}

/// A text as the compiler reads it, without the grammar's rule for the whole.
struct ReadText {
  explicit ReadText(std::string text) {
    const SourceId id = sources.add("a.robdef", std::move(text));
    const ast::File file = ast::parse(sources[id], id, report);
    fits = file.service.has_value();
    for (const Diagnostic* diagnostic : report.sorted()) {
      const bool is_error = diagnostic->severity() == Severity::error;
      has_broken_lines = has_broken_lines || diagnostic->code() <= Code::R0104;
      fits = fits && (!is_error || is_left_to_checks(diagnostic->code()));
    }
    for (const ast::Line& line : file.written.lines) {
      const bool is_code =
          line.kind == ast::LineKind::statement || line.kind == ast::LineKind::unread;
      if (!is_code) continue;
      const std::string content =
          joined(std::string_view(sources[id].text()).substr(line.begin, line.end - line.begin));
      if (content.empty()) continue;  // blanks that go on
      fits = fits && line.kind == ast::LineKind::statement;
      logical_text += content + '\n';
    }
  }

  Sources sources;
  Report report;
  std::string logical_text;       ///< all statements, each on one line
  bool has_broken_lines = false;  ///< there are no statements to begin with (L1 to L4)
  bool fits = true;               ///< the compiler has nothing against its form
};

std::size_t mistakes(const std::string& text) {
  antlr4::ANTLRInputStream input(text);
  grammar::RobdefLexer lexer(&input);
  antlr4::CommonTokenStream tokens(&lexer);
  grammar::RobdefParser parser(&tokens);
  parser.removeErrorListeners();
  parser.definition();
  return parser.getNumberOfSyntaxErrors();
}

TEST(Grammar, AcceptsEachExampleThatIsAccepted) {
  for (const Example& example : read_examples(fs::path(ROBDEF_CORPUS_DIR) / "accept")) {
    EXPECT_EQ(mistakes(ReadText(GoldenCorpus::read(example.file)).logical_text), 0U)
        << example.file;
  }
}

TEST(Grammar, RefusesWhatStandsInTheWrongPlace) {
  EXPECT_EQ(mistakes("service a\nstruct S\nfield double x\nend\n"), 0U);
  EXPECT_NE(mistakes("struct S\nfield double x\nend\n"), 0U);
  EXPECT_NE(mistakes("service a\nstruct S\nproperty double x\nend\n"), 0U);
  EXPECT_NE(mistakes("service a\nstruct S\nfield double x\n"), 0U);
  EXPECT_NE(mistakes("service a\nstruct S\nend\nconstant int32 A 5\n"), 0U);
  EXPECT_NE(mistakes("service a\nobject O\nproperty double x\nimplements P\nend\n"), 0U);
  EXPECT_NE(mistakes("service a\nenum E\na = 1, # b\nend\n"), 0U);
}

TEST(Grammar, RefusesAConstantBehindAField) {
  EXPECT_EQ(mistakes("service a\nstruct S\nconstant int32 A 5\nfield double x\nend\n"), 0U);
  EXPECT_NE(mistakes("service a\nstruct S\nfield double x\nconstant int32 A 5\nend\n"), 0U)
      << "P21";
}

TEST(Grammar, WantsACommaBehindEachLineOfAnEnumButTheLast) {
  EXPECT_EQ(mistakes("service a\nenum E\na = 1, b,\nc\nend\n"), 0U);
  EXPECT_EQ(mistakes("service a\nenum E\na = 1,\nb,,\nend\n"), 0U) << "Q19";
  EXPECT_NE(mistakes("service a\nenum E\na = 1\nb\nend\n"), 0U) << "P31";
}

// Empty when the grammar accepts what the compiler accepts, and refuses what it refuses.
std::string disagreement(const std::string& text) {
  const ReadText read(text);
  if (read.has_broken_lines) return "";
  const bool is_accepted = mistakes(read.logical_text) == 0;
  if (is_accepted == read.fits) return "";
  return (is_accepted ? "only the grammar accepts:\n" : "only the compiler accepts:\n") +
         render(read.report, read.sources, Format::line) + text;
}

std::vector<std::string> example_texts() {
  std::vector<std::string> texts;
  for (const char* const folder : {"accept", "reject", "syntax"}) {
    const GoldenCorpus corpus(fs::path(ROBDEF_CORPUS_DIR) / folder);
    for (const fs::path& input : corpus.inputs()) texts.push_back(GoldenCorpus::read(input));
  }
  return texts;
}

TEST(GrammarAndCompiler, AgreeOnAllExamples) {
  const std::vector<std::string> texts = example_texts();
  EXPECT_GE(texts.size(), 280U);
  for (const std::string& text : texts) EXPECT_EQ(disagreement(text), "");
}

class GrammarMutations : public testing::TestWithParam<std::uint64_t> {};

TEST_P(GrammarMutations, AgreeWithTheCompiler) {
  constexpr std::uint64_t count = 1000;
  const std::vector<std::string> texts = example_texts();
  std::size_t compared = 0;
  std::size_t accepted = 0;
  for (std::uint64_t seed = GetParam() * count; seed < (GetParam() + 1) * count; ++seed) {
    const std::string text = mutated(texts[seed % texts.size()], seed);
    EXPECT_EQ(disagreement(text), "") << "seed " << seed;
    const ReadText read(text);
    compared += read.has_broken_lines ? 0 : 1;
    accepted += !read.has_broken_lines && read.fits ? 1 : 0;
  }
  EXPECT_GT(compared, count / 2);
  EXPECT_GT(accepted, count / 20);
}

INSTANTIATE_TEST_SUITE_P(FiveThousand, GrammarMutations, testing::Range<std::uint64_t>(0, 5));

}  // namespace
}  // namespace robdef::syntax
