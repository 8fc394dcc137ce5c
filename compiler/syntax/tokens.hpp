// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <RobdefParser.h>

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/syntax/faults.hpp"
#include "compiler/syntax/line_lexer.hpp"

namespace robdef::syntax {

/// The tokens of one logical line, for the parser; the last one is the line's end.
class LineTokens : public antlr4::TokenStream {
 public:
  /// Reads all tokens of a line's text, beginning in this mode of the lexer, and its end.
  void load(std::string_view text, std::size_t mode);

  /// Adds them as parts of a file: without the line's end, and without the blanks that the grammar
  /// holds inside of tokens.
  void append_to(const LogicalLine& line, std::vector<ast::Token>& tokens) const;

  void consume() override;
  size_t LA(ssize_t offset) override { return LT(offset)->getType(); }
  antlr4::Token* LT(ssize_t offset) override;
  ssize_t mark() override { return 0; }
  void release(ssize_t) override {}
  size_t index() override { return next_; }
  void seek(size_t index) override { next_ = index; }
  size_t size() override { return count_; }
  antlr4::Token* get(size_t index) const override { return tokens_[index].get(); }
  // The runtime wants it to make up tokens that are missing, and a line is given up before that.
  antlr4::TokenSource* getTokenSource() const override { return nullptr; }
  std::string getSourceName() const override { return {}; }
  // No message is made by the runtime, so nobody asks for text.
  std::string getText(const antlr4::misc::Interval&) override { return {}; }
  std::string getText() override { return {}; }
  std::string getText(antlr4::RuleContext*) override { return {}; }
  std::string getText(antlr4::Token*, antlr4::Token*) override { return {}; }

 private:
  void add(const LexedToken& token);

  // Those behind `count_` are of earlier lines: they are used again.
  std::vector<std::unique_ptr<antlr4::CommonToken>> tokens_;
  std::size_t count_ = 0;
  std::size_t next_ = 0;
};

/// Keeps the first place where a line does not fit the grammar, and gives the line up there by
/// antlr4::ParseCancellationException.
class FirstFault : public antlr4::DefaultErrorStrategy {
 public:
  explicit FirstFault(const LineTokens& tokens) : tokens_(tokens) {}

  [[nodiscard]] const Fault& fault() const { return fault_; }

  void reportError(antlr4::Parser* parser, const antlr4::RecognitionException& error) override;
  void recover(antlr4::Parser* parser, std::exception_ptr error) override;
  antlr4::Token* recoverInline(antlr4::Parser* parser) override;
  void sync(antlr4::Parser*) override {}

 private:
  void keep(antlr4::RuleContext* context, const antlr4::Token& token);

  const LineTokens& tokens_;
  Fault fault_;
};

}  // namespace robdef::syntax
