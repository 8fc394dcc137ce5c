// SPDX-License-Identifier: Apache-2.0
// The tokens of a line are those that the generated lexer gives.
#include "compiler/syntax/line_lexer.hpp"

#include <RobdefLexer.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/golden_corpus.hpp"
#include "compiler/diagnostics/mutations.hpp"

namespace robdef::syntax {

// How GoogleTest shows one.
void PrintTo(const LexedToken& token, std::ostream* out) {
  *out << token.type << " [" << token.begin << ", " << token.end << ")";
}

namespace {

using Lexer = grammar::RobdefLexer;

// Each byte as one character, which is what the compiler reads.
std::string utf8_of_bytes(std::string_view bytes) {
  std::string text;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      text += c;
    } else {
      text += static_cast<char>(0xc0 | (byte >> 6));
      text += static_cast<char>(0x80 | (byte & 0x3f));
    }
  }
  return text;
}

std::vector<LexedToken> tokens_of_generated_lexer(std::string_view text, std::size_t mode) {
  antlr4::ANTLRInputStream input(utf8_of_bytes(text) + '\n');
  Lexer lexer(&input);
  lexer.removeErrorListeners();
  lexer.setMode(mode);
  std::vector<LexedToken> tokens;
  do {
    const auto token = lexer.nextToken();
    tokens.push_back({token->getType(), token->getStartIndex(), token->getStopIndex() + 1});
  } while (tokens.back().type != Lexer::NL);
  return tokens;
}

std::vector<LexedToken> tokens_of(std::string_view text, std::size_t mode) {
  LineLexer lexer(text, mode);
  std::vector<LexedToken> tokens;
  do {
    tokens.push_back(lexer.next());
  } while (tokens.back().type != Lexer::NL);
  return tokens;
}

void expect_same_tokens(std::string_view text, std::size_t mode) {
  EXPECT_EQ(tokens_of(text, mode), tokens_of_generated_lexer(text, mode))
      << "mode " << mode << ": " << text;
}

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

TEST(LineLexer, GivesTypesAndPlaces) {
  const std::vector<LexedToken> tokens = tokens_of("field double[3] x [readonly]", 0);
  const std::vector<LexedToken> wanted = {{Lexer::FIELD, 0, 6},
                                          {Lexer::MEMBER_WORD, 6, 12},
                                          {Lexer::OPEN_ARRAY, 12, 13},
                                          {Lexer::DIGITS, 13, 14},
                                          {Lexer::CLOSE_ARRAY, 14, 15},
                                          {Lexer::SPACED_WORD, 15, 17},
                                          {Lexer::OPEN_MODIFIERS, 17, 19},
                                          {Lexer::NAME, 19, 27},
                                          {Lexer::CLOSE_MODIFIERS, 27, 28},
                                          {Lexer::NL, 28, 29}};
  EXPECT_EQ(tokens, wanted);
}

TEST(LineLexer, EndsAnEmptyLine) {
  const std::vector<LexedToken> wanted = {{Lexer::NL, 0, 1}};
  EXPECT_EQ(tokens_of("", Lexer::DEFAULT_MODE), wanted);
  EXPECT_EQ(tokens_of("", Lexer::EnumBody), wanted);
}

// The generated lexer reads all characters as they are, and has a rule for each.
TEST(LineLexer, ReadsBytesThatAreNoText) {
  const std::vector<LexedToken> wanted = {
      {Lexer::UNEXPECTED, 0, 1}, {Lexer::UNEXPECTED, 1, 2}, {Lexer::NL, 2, 3}};
  EXPECT_EQ(tokens_of(std::string_view("\xff\0", 2), Lexer::DEFAULT_MODE), wanted);
}

std::vector<std::string> corpus_texts() {
  std::vector<std::string> texts;
  for (const char* const folder : {"accept", "reject", "syntax"}) {
    const GoldenCorpus corpus(std::filesystem::path(ROBDEF_CORPUS_DIR) / folder);
    for (const auto& input : corpus.inputs()) texts.push_back(GoldenCorpus::read(input));
  }
  return texts;
}

TEST(LineLexer, IsTheGeneratedLexerOnAllLinesOfTheCorpus) {
  std::size_t lines = 0;
  for (const std::string& text : corpus_texts()) {
    for (const std::string& line : lines_of(text)) {
      expect_same_tokens(line, Lexer::DEFAULT_MODE);
      expect_same_tokens(line, Lexer::EnumBody);
      ++lines;
    }
  }
  EXPECT_GT(lines, 1000U);
}

TEST(LineLexer, IsTheGeneratedLexerOnMutatedLines) {
  const std::vector<std::string> texts = corpus_texts();
  constexpr std::uint64_t count = 2000;
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    for (const std::string& line : lines_of(mutated(texts[seed % texts.size()], seed))) {
      expect_same_tokens(line, Lexer::DEFAULT_MODE);
    }
  }
}

}  // namespace
}  // namespace robdef::syntax
