// SPDX-License-Identifier: Apache-2.0
#include "compiler/syntax/tokens.hpp"

#include <algorithm>

#include "compiler/syntax/words.hpp"

namespace robdef::syntax {
namespace {

FaultToken fault_token(const antlr4::Token& token) {
  return {token.getType(), token.getStartIndex(), token.getStopIndex() + 1};
}

using Parser = grammar::RobdefParser;

ast::TokenKind kind_of(const antlr4::Token& token) {
  using ast::TokenKind;
  switch (token.getType()) {
    case Parser::NAME:
    case Parser::DOTTED:
    case Parser::MEMBER_WORD:
    case Parser::MEMBER_QUALIFIED:
    case Parser::MEMBER_OTHER_WORD:
    case Parser::SPACED_WORD:
    case Parser::ENUM_WORD:
      return TokenKind::name;
    case Parser::INT:
    case Parser::HEX:
    case Parser::FLOAT:
    case Parser::DIGITS:
      return TokenKind::number;
    case Parser::VERSION:
      return TokenKind::version;
    case Parser::STRING:
      return TokenKind::string;
    case Parser::OPTION_WORD:
    case Parser::OPTION_TEXT:
      return TokenKind::text;
    case Parser::MINUS:
    case Parser::STAR:
      return TokenKind::symbol;
    case Parser::COMMA:
    case Parser::SPACED_COMMA:
      return TokenKind::comma;
    case Parser::EQUALS:
      return TokenKind::equals;
    case Parser::COLON:
      return TokenKind::colon;
    case Parser::OPEN_PARAMETERS:
      return TokenKind::open_parameters;
    case Parser::CLOSE_PARAMETERS:
      return TokenKind::close_parameters;
    case Parser::OPEN_ARRAY:
      return TokenKind::open_array;
    case Parser::CLOSE_ARRAY:
      return TokenKind::close_array;
    case Parser::OPEN_CONTAINER:
      return TokenKind::open_container;
    case Parser::CLOSE_CONTAINER:
      return TokenKind::close_container;
    case Parser::OPEN_MODIFIERS:
      return TokenKind::open_modifiers;
    case Parser::CLOSE_MODIFIERS:
      return TokenKind::close_modifiers;
    case Parser::OPEN_ARGUMENTS:
      return TokenKind::open_arguments;
    case Parser::CLOSE_ARGUMENTS:
      return TokenKind::close_arguments;
    case Parser::OPEN_VALUE:
      return TokenKind::open_value;
    case Parser::CLOSE_VALUE:
      return TokenKind::close_value;
    default:
      return TokenKind::keyword;
  }
}

}  // namespace

void LineTokens::load(std::string_view text, std::size_t mode) {
  count_ = 0;
  next_ = 0;
  LineLexer lexer(text, mode);
  while (true) {
    const LexedToken token = lexer.next();
    add(token);
    if (token.type == Parser::NL) return;
  }
}

void LineTokens::add(const LexedToken& token) {
  if (count_ == tokens_.size()) {
    tokens_.push_back(std::make_unique<antlr4::CommonToken>(token.type));
  }
  antlr4::CommonToken& added = *tokens_[count_];
  added.setType(token.type);
  added.setStartIndex(token.begin);
  added.setStopIndex(token.end - 1);
  added.setTokenIndex(count_++);
}

void LineTokens::append_to(const LogicalLine& line, std::vector<ast::Token>& tokens) const {
  const std::string_view text = line.text();
  for (std::size_t index = 0; index + 1 < count_; ++index) {
    const antlr4::Token& token = *tokens_[index];
    std::size_t begin = token.getStartIndex();
    std::size_t end = token.getStopIndex() + 1;
    while (begin < end && is_blank(text[begin])) ++begin;
    while (begin < end && is_blank(text[end - 1])) --end;
    const Span span = line.span(begin, end);
    tokens.push_back({kind_of(token), span.begin, span.end});
  }
}

void LineTokens::consume() {
  if (next_ < count_) ++next_;
}

antlr4::Token* LineTokens::LT(ssize_t offset) {
  if (offset > 0) {
    // Behind the line's end there is nothing but the line's end.
    const std::size_t at = next_ + static_cast<std::size_t>(offset) - 1;
    return tokens_[std::min(at, count_ - 1)].get();
  }
  const auto back = static_cast<std::size_t>(-offset);
  return back == 0 || back > next_ ? nullptr : tokens_[next_ - back].get();
}

void FirstFault::reportError(antlr4::Parser*, const antlr4::RecognitionException& error) {
  keep(error.getCtx(), *error.getOffendingToken());
}

void FirstFault::recover(antlr4::Parser*, std::exception_ptr) {
  throw antlr4::ParseCancellationException();
}

antlr4::Token* FirstFault::recoverInline(antlr4::Parser* parser) {
  keep(parser->getContext(), *parser->getCurrentToken());
  throw antlr4::ParseCancellationException();
}

void FirstFault::keep(antlr4::RuleContext* context, const antlr4::Token& token) {
  fault_ = {};
  const auto* const rule = dynamic_cast<const antlr4::ParserRuleContext*>(context);
  if (rule != nullptr && rule->start != nullptr) fault_.rule_begin = rule->start->getStartIndex();
  for (antlr4::tree::ParseTree* node = context; node != nullptr; node = node->parent) {
    const auto* const enclosing = dynamic_cast<const antlr4::RuleContext*>(node);
    if (enclosing != nullptr) fault_.rules.push_back(enclosing->getRuleIndex());
  }
  fault_.keyword = tokens_.get(0)->getType();
  fault_.token = fault_token(token);
  const std::size_t index = token.getTokenIndex();
  if (index > 0) fault_.previous = fault_token(*tokens_.get(index - 1));
  if (index > 1) fault_.before_previous = fault_token(*tokens_.get(index - 2));
}

}  // namespace robdef::syntax
