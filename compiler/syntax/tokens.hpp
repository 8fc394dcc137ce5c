// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <RobdefLexer.h>
#include <RobdefParser.h>

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/syntax/faults.hpp"

namespace robdef::syntax {

/// The characters of one logical line and its line end, for the lexer. Offsets are those of the
/// line's text.
class LineCharacters : public antlr4::CharStream {
 public:
  void set(std::string_view text);

  void consume() override { ++next_; }
  size_t LA(ssize_t offset) override;
  ssize_t mark() override { return 0; }
  void release(ssize_t) override {}
  size_t index() override { return next_; }
  void seek(size_t index) override { next_ = index; }
  size_t size() override { return text_.size() + 1; }
  std::string getSourceName() const override { return {}; }
  std::string getText(const antlr4::misc::Interval& interval) override;
  std::string toString() const override { return std::string(text_); }

 private:
  std::string_view text_;
  std::size_t next_ = 0;
};

/// The tokens of one logical line, for the parser; the last one is the line's end.
class LineTokens : public antlr4::TokenStream {
 public:
  /// Reads all tokens up to the line's end.
  void load(antlr4::Lexer& lexer);

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
  size_t size() override { return tokens_.size(); }
  antlr4::Token* get(size_t index) const override { return tokens_[index].get(); }
  antlr4::TokenSource* getTokenSource() const override { return source_; }
  std::string getSourceName() const override { return {}; }
  // No message is made by the runtime, so nobody asks for text.
  std::string getText(const antlr4::misc::Interval&) override { return {}; }
  std::string getText() override { return {}; }
  std::string getText(antlr4::RuleContext*) override { return {}; }
  std::string getText(antlr4::Token*, antlr4::Token*) override { return {}; }

 private:
  std::vector<std::unique_ptr<antlr4::Token>> tokens_;
  antlr4::TokenSource* source_ = nullptr;
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
