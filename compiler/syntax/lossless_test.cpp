// SPDX-License-Identifier: Apache-2.0
#include "compiler/syntax/lossless.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "compiler/syntax/parse.hpp"

namespace robdef::ast {
namespace {

using testing::ElementsAre;

struct Read {
  explicit Read(std::string text) {
    const SourceId id = sources.add("a.robdef", std::move(text));
    file = parse(sources[id], id, report);
  }

  [[nodiscard]] std::string part(std::uint32_t begin, std::uint32_t end) const {
    return sources[SourceId{}].text().substr(begin, end - begin);
  }
  // `statement 1 3`: kind, whether in a block, physical lines.
  [[nodiscard]] std::vector<std::string> lines() const {
    std::vector<std::string> result;
    for (const Line& line : file.written.lines) {
      const std::string text = part(line.begin, line.end);
      result.push_back(std::string(name_of(line.kind)) + (line.is_in_block ? " 1 " : " 0 ") +
                       std::to_string(std::count(text.begin(), text.end(), '\n')));
    }
    return result;
  }
  [[nodiscard]] std::vector<std::string> tokens(std::size_t line) const {
    std::vector<std::string> result;
    for (const Token& token : file.written.tokens_of(file.written.lines[line])) {
      result.push_back(std::string(name_of(token.kind)) + ' ' + part(token.begin, token.end));
    }
    return result;
  }

  Sources sources;
  Report report;
  File file;
};

TEST(Lossless, EachLineHasItsKindAndPlace) {
  const Read read(
      "service a\n\n# b\n## c\nobject O\n## d \\\n e\n\nevent e(double a, \\\n double "
      "b)\nfoo\nend\n");
  EXPECT_THAT(read.lines(),
              ElementsAre("statement 0 1", "blank 0 1", "comment 0 1", "documentation 0 1",
                          "statement 0 1", "documentation 1 2", "blank 1 1", "statement 1 2",
                          "unread 1 1", "statement 0 1"));
}

TEST(Lossless, TokensAreWithoutBlanks) {
  const Read read(
      "service a\nobject O\nfunction  double[2] f (a.B{list} x ) [r(1 , N),nolock]\nend");
  EXPECT_THAT(
      read.tokens(2),
      ElementsAre("keyword function", "name double", "open_array [", "number 2", "close_array ]",
                  "name f", "open_parameters (", "name a.B", "open_container {", "keyword list",
                  "close_container }", "name x", "close_parameters )", "open_modifiers [", "name r",
                  "open_arguments (", "number 1", "comma ,", "name N", "close_arguments )",
                  "comma ,", "name nolock", "close_modifiers ]"));
}

TEST(Lossless, ConstantsEnumsAndUsingsHaveTheirTokens) {
  const Read read(
      "service a\nusing b.C as D\nconstant struct P {x: A}\nconstant string S \"a b\"\n"
      "enum E\na = 0x1,\nend\n");
  EXPECT_THAT(read.tokens(1), ElementsAre("keyword using", "name b.C", "keyword as", "name D"));
  EXPECT_THAT(read.tokens(2),
              ElementsAre("keyword constant", "name struct", "name P", "open_value {", "name x",
                          "colon :", "name A", "close_value }"));
  EXPECT_THAT(read.tokens(3),
              ElementsAre("keyword constant", "name string", "name S", "string \"a b\""));
  EXPECT_THAT(read.tokens(5), ElementsAre("name a", "equals =", "number 0x1", "comma ,"));
}

TEST(Lossless, WhatWasCutBadlyIsOneLine) {
  const Read read("service a\nobject O\nevent e(double a, \\ \n double b)\nend\n");
  EXPECT_THAT(read.lines(),
              ElementsAre("statement 0 1", "statement 0 1", "unread 1 2", "statement 0 1"));
}

TEST(Lossless, ALineIsFoundByItsOffset) {
  const Read read("\xEF\xBB\xBFservice a\n\nend");
  const LosslessText& written = read.file.written;
  EXPECT_EQ(written.line_at(0), nullptr);
  EXPECT_EQ(written.line_at(3), &written.lines[0]);
  EXPECT_EQ(written.line_at(12), &written.lines[0]);
  EXPECT_EQ(written.line_at(13), &written.lines[1]);
  EXPECT_EQ(written.line_at(16), &written.lines[2]);
  EXPECT_EQ(written.line_at(17), nullptr);
}

}  // namespace
}  // namespace robdef::ast
