// SPDX-License-Identifier: Apache-2.0
// The compiler enters the grammar line by line. Here the grammar is taken as a whole, by its first
// rule, as other tools may use it.
#include <RobdefLexer.h>
#include <RobdefParser.h>
#include <gtest/gtest.h>

#include "compiler/diagnostics/golden_corpus.hpp"
#include "compiler/syntax/lines.hpp"
#include "compiler/syntax/words.hpp"

namespace robdef::syntax {
namespace {

namespace fs = std::filesystem;

// All logical lines of a file, each with a line end.
std::string logical_text(const fs::path& path) {
  Sources sources;
  const SourceId id = sources.add(path.string(), GoldenCorpus::read(path));
  Report report;
  LineReader reader(sources[id], id, report);
  LogicalLine line;
  std::string text;
  bool is_in_block = false;
  while (reader.next(is_in_block, line)) {
    const std::string_view content = line.text();
    const Keyword keyword = keyword_of(content.substr(0, content.find_first_of(" \t")));
    const bool opens = keyword >= Keyword::enum_ && keyword <= Keyword::object;
    is_in_block = (is_in_block || opens) && keyword != Keyword::end;
    text += content;
    text += '\n';
  }
  return text;
}

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
    EXPECT_EQ(mistakes(logical_text(example.file)), 0U) << example.file;
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

}  // namespace
}  // namespace robdef::syntax
