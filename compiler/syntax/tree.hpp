// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <RobdefParser.h>

#include <optional>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/report.hpp"
#include "compiler/syntax/ast.hpp"
#include "compiler/syntax/line_parser.hpp"
#include "compiler/syntax/lines.hpp"

namespace robdef::syntax {

/// Makes syntax tree nodes from what the parser read of one logical line. What the grammar lets
/// through and the language does not (P05, P28, P29, P30) is reported, and `failed` then says that
/// the node is not to be used.
class LineTree {
 public:
  using Parser = grammar::RobdefParser;

  LineTree(const LogicalLine& line, Report& report) : line_(line), report_(report) {}

  [[nodiscard]] bool failed() const { return failed_; }

  ast::Name name(const antlr4::ParserRuleContext* context) const;
  ast::Name name(antlr4::tree::TerminalNode* node) const;

  VersionLine version(antlr4::tree::TerminalNode* node, Code too_large);
  ast::Using using_line(Parser::UsingLineContext* context) const;
  EnumLine enum_line(Parser::EnumLineContext* context);
  ast::Field field(Parser::FieldLineContext* context);
  ast::Member member(Parser::MemberLineContext* context);
  ast::Constant constant(Parser::ConstantPartsContext* context);

 private:
  ast::Name name(const antlr4::Token* token) const;
  [[nodiscard]] Span span(const antlr4::ParserRuleContext* context) const;
  [[nodiscard]] Span span(const antlr4::Token* token) const;
  [[nodiscard]] std::string_view text(const antlr4::Token* token) const;

  /// What a field or member is made of.
  struct MemberParts {
    std::optional<ast::TypeRef> type;
    ast::Name name;
    std::vector<ast::Parameter> parameters;
    std::vector<ast::Modifier> modifiers;
  };
  MemberParts member_parts(antlr4::ParserRuleContext* context);
  ast::TypeRef type(antlr4::ParserRuleContext* context);
  void read_array(Parser::ArrayContext* context, ast::TypeRef& type);
  void read_dimension(antlr4::tree::TerminalNode* node, ast::TypeRef& type);
  void read_container(Parser::ContainerContext* context, ast::TypeRef& type) const;
  std::vector<ast::Parameter> parameters(antlr4::ParserRuleContext* context);
  std::vector<ast::Modifier> modifiers(Parser::ModifiersContext* context);
  ast::Modifier modifier(Parser::ModifierContext* context) const;
  ast::NumberLiteral number(const antlr4::ParserRuleContext* context) const;
  ast::ConstantValue value(Parser::ConstantValueContext& context);
  ast::StringLiteral string(antlr4::tree::TerminalNode* node);
  Span value_span(const antlr4::ParserRuleContext& context) const;

  const LogicalLine& line_;
  Report& report_;
  bool failed_ = false;
};

}  // namespace robdef::syntax
