// SPDX-License-Identifier: Apache-2.0
#include "compiler/syntax/tree.hpp"

#include <fmt/format.h>

#include <charconv>
#include <system_error>
#include <utility>

#include "compiler/syntax/constants.hpp"
#include "compiler/syntax/literals.hpp"
#include "compiler/syntax/types.hpp"
#include "compiler/syntax/words.hpp"

namespace robdef::syntax {
namespace {

using Parser = LineTree::Parser;

constexpr std::uint32_t largest_dimension = 2147483647;

ast::MemberKind kind_of(const antlr4::Token* keyword) {
  switch (keyword->getType()) {
    case Parser::FUNCTION:
      return ast::MemberKind::function;
    case Parser::EVENT:
      return ast::MemberKind::event;
    case Parser::OBJREF:
      return ast::MemberKind::objref;
    case Parser::PIPE:
      return ast::MemberKind::pipe;
    case Parser::CALLBACK:
      return ast::MemberKind::callback;
    case Parser::WIRE:
      return ast::MemberKind::wire;
    case Parser::MEMORY:
      return ast::MemberKind::memory;
    default:
      return ast::MemberKind::property;
  }
}

// Saturates; what is too large for a dimension is too large for a version as well.
std::uint32_t read_digits(std::string_view digits) {
  std::uint32_t value = 0;
  const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return read.ec == std::errc() ? value : ~std::uint32_t{0};
}

ast::ArrayForm form_of(Parser::ArrayContext* context) {
  if (dynamic_cast<Parser::AnyLengthContext*>(context)) return ast::ArrayForm::any_length;
  if (dynamic_cast<Parser::FixedLengthContext*>(context)) return ast::ArrayForm::fixed_length;
  if (dynamic_cast<Parser::MaximumLengthContext*>(context)) return ast::ArrayForm::maximum_length;
  if (dynamic_cast<Parser::AnyShapeContext*>(context)) return ast::ArrayForm::any_shape;
  return ast::ArrayForm::fixed_shape;
}

// Children whose kind is known from the grammar.
antlr4::ParserRuleContext* rule_at(const antlr4::ParserRuleContext* context, std::size_t index) {
  return static_cast<antlr4::ParserRuleContext*>(context->children[index]);
}

antlr4::tree::TerminalNode* token_at(const antlr4::ParserRuleContext* context, std::size_t index) {
  return static_cast<antlr4::tree::TerminalNode*>(context->children[index]);
}

}  // namespace

std::string_view LineTree::text(const antlr4::Token* token) const {
  return line_.text().substr(token->getStartIndex(),
                             token->getStopIndex() + 1 - token->getStartIndex());
}

Span LineTree::span(const antlr4::Token* token) const {
  return line_.span(token->getStartIndex(), token->getStopIndex() + 1);
}

Span LineTree::span(const antlr4::ParserRuleContext* context) const {
  return line_.span(context->start->getStartIndex(), context->stop->getStopIndex() + 1);
}

ast::Name LineTree::name(const antlr4::ParserRuleContext* context) const {
  return name(context->start);
}

ast::Name LineTree::name(antlr4::tree::TerminalNode* node) const { return name(node->getSymbol()); }

// Some words come with the blanks before them.
ast::Name LineTree::name(const antlr4::Token* token) const {
  std::size_t begin = token->getStartIndex();
  while (is_blank(line_.text()[begin])) ++begin;
  const std::size_t end = token->getStopIndex() + 1;
  return {std::string(line_.text().substr(begin, end - begin)), line_.span(begin, end)};
}

VersionLine LineTree::version(antlr4::tree::TerminalNode* node, Code too_large) {
  const antlr4::Token* const token = node->getSymbol();
  VersionLine result{{}, span(token)};
  std::string_view rest = text(token);
  for (std::uint32_t& number : result.version.numbers) {
    const std::size_t dot = rest.find('.');
    number = read_digits(rest.substr(0, dot));
    if (number == ~std::uint32_t{0}) {
      failed_ = true;
      report_.add(too_large, result.span, "a version number that is too large");
      break;
    }
    if (dot == std::string_view::npos) break;
    rest.remove_prefix(dot + 1);
  }
  return result;
}

ast::Using LineTree::using_line(Parser::UsingLineContext* context) const {
  ast::Using result{name(context->DOTTED()), std::nullopt, line_.span()};
  if (context->AS() != nullptr) result.alias = name(context->NAME());
  return result;
}

EnumLine LineTree::enum_line(Parser::EnumLineContext* context) {
  EnumLine result;
  for (Parser::EnumValueContext* const item : context->enumValue()) {
    ast::EnumValue value{name(item->ENUM_WORD()), std::nullopt, {}};
    if (item->enumNumber() != nullptr) value.value = number(item->enumNumber());
    result.values.push_back(std::move(value));
  }
  const auto commas = context->COMMA();
  result.ends_in_comma = commas.size() >= result.values.size();
  if (commas.size() > result.values.size()) {
    report_
        .add(Code::R0144, span(commas.back()->getSymbol()),
             "more than one comma at the end of an enum line")
        .help("write one");
  }
  result.values.front().documentation = line_.documentation();
  return result;
}

ast::Field LineTree::field(Parser::FieldLineContext* context) {
  MemberParts parts = member_parts(context);
  return {std::move(*parts.type), std::move(parts.name), std::move(parts.modifiers),
          line_.documentation(), line_.span()};
}

ast::Member LineTree::member(Parser::MemberLineContext* context) {
  MemberParts parts = member_parts(context);
  ast::Member result{kind_of(context->start),
                     std::move(parts.type),
                     std::move(parts.name),
                     std::move(parts.parameters),
                     std::move(parts.modifiers),
                     line_.documentation(),
                     line_.span()};
  if (result.kind == ast::MemberKind::objref && !failed_) {
    failed_ = !check_objref_type(*result.type, report_);
  }
  return result;
}

// Fields and members are most of a definition. The typed accessors of a context look through all of
// its children by dynamic_cast, which would be a third of the time that reading takes. Here the
// grammar says what stands where: a type and a name, or the name of an event, and then lists.
LineTree::MemberParts LineTree::member_parts(antlr4::ParserRuleContext* context) {
  MemberParts parts;
  std::size_t next = 2;
  if (context->start->getType() == Parser::EVENT) {
    parts.name = name(rule_at(context, 1));
  } else {
    parts.type = type(rule_at(context, 1));
    parts.name = name(token_at(context, 2));
    next = 3;
  }
  // The last child is the line end.
  for (; next + 1 < context->children.size(); ++next) {
    auto* const list = rule_at(context, next);
    if (list->getRuleIndex() == Parser::RuleParameters) {
      parts.parameters = parameters(list);
    } else {
      parts.modifiers = modifiers(static_cast<Parser::ModifiersContext*>(list));
    }
  }
  return parts;
}

// `base array? container?`, where the base is a single token.
ast::TypeRef LineTree::type(antlr4::ParserRuleContext* context) {
  ast::TypeRef result;
  result.span = span(context);
  result.base = name(context);
  for (std::size_t i = 1; i < context->children.size(); ++i) {
    auto* const part = rule_at(context, i);
    if (part->getRuleIndex() == Parser::RuleArray) {
      read_array(static_cast<Parser::ArrayContext*>(part), result);
    } else {
      read_container(static_cast<Parser::ContainerContext*>(part), result);
    }
  }
  return result;
}

void LineTree::read_array(Parser::ArrayContext* context, ast::TypeRef& type) {
  type.array = form_of(context);
  type.array_span = span(context);
  for (antlr4::tree::TerminalNode* const digits : context->getTokens(Parser::DIGITS)) {
    read_dimension(digits, type);
  }
}

void LineTree::read_dimension(antlr4::tree::TerminalNode* node, ast::TypeRef& type) {
  const std::uint32_t value = read_digits(text(node->getSymbol()));
  if (value > largest_dimension) {
    failed_ = true;
    report_.add(Code::R0130, span(node->getSymbol()), "an array dimension that is too large")
        .label(fmt::format("the largest is {}", largest_dimension));
  }
  type.dimensions.push_back(value);
}

void LineTree::read_container(Parser::ContainerContext* context, ast::TypeRef& type) const {
  const std::string_view kind = text(context->CONTAINER_KIND()->getSymbol());
  type.container = kind == "list"     ? ast::ContainerForm::list
                   : kind == "int32"  ? ast::ContainerForm::int32_map
                   : kind == "string" ? ast::ContainerForm::string_map
                                      : ast::ContainerForm::generator;
  type.container_span = span(context);
}

// Every second child is a parenthesis or comma; a parameter is a type and a word.
std::vector<ast::Parameter> LineTree::parameters(antlr4::ParserRuleContext* context) {
  std::vector<ast::Parameter> result;
  if (context->children.size() <= 2) return result;
  result.reserve(context->children.size() / 2);
  for (std::size_t i = 1; i < context->children.size(); i += 2) {
    const auto* const item = rule_at(context, i);
    result.push_back({type(rule_at(item, 0)), name(token_at(item, 1))});
  }
  return result;
}

std::vector<ast::Modifier> LineTree::modifiers(Parser::ModifiersContext* context) {
  std::vector<ast::Modifier> result;
  for (Parser::ModifierContext* const item : context->modifier()) result.push_back(modifier(item));
  const auto commas = context->COMMA();
  if (commas.size() == result.size()) {
    report_.add(Code::R0143, span(commas.back()->getSymbol()), "a comma behind the last modifier")
        .help("remove it");
  }
  return result;
}

ast::Modifier LineTree::modifier(Parser::ModifierContext* context) const {
  ast::Modifier result{name(context->NAME()), {}, span(context)};
  if (context->arguments() == nullptr) return result;
  for (Parser::ArgumentContext* const item : context->arguments()->argument()) {
    result.arguments.push_back({std::string(text(item->start)), span(item->start),
                                item->start->getType() == Parser::NAME});
  }
  return result;
}

ast::NumberLiteral LineTree::number(const antlr4::ParserRuleContext* context) const {
  return {std::string(text(context->start)), span(context->start)};
}

ast::Constant LineTree::constant(Parser::ConstantPartsContext* context) {
  ast::Constant result;
  Parser::ConstantTypeContext* const written = context->constantType();
  result.type.span = span(written);
  result.type.base = name(written->dotted());
  if (auto* const array = written->array()) read_array(array, result.type);
  if (auto* const container = written->container()) read_container(container, result.type);
  result.name = name(context->NAME());
  result.value = value(*context->constantValue());
  // The grammar cannot tell the `{}` of an array from that of a struct.
  const auto* const array = std::get_if<ast::ArrayLiteral>(&result.value);
  if (array != nullptr && array->items.empty() && !is_built_in_type(result.type.base.text)) {
    result.value = ast::StructLiteral{{}, array->span};
  }
  result.documentation = line_.documentation();
  result.span = line_.span();
  if (!failed_) failed_ = !check_constant(result, report_);
  return result;
}

ast::ConstantValue LineTree::value(Parser::ConstantValueContext& context) {
  if (auto* const written = dynamic_cast<Parser::NumberValueContext*>(&context)) {
    return number(written->number());
  }
  if (auto* const written = dynamic_cast<Parser::StringValueContext*>(&context)) {
    return string(written->STRING());
  }
  if (auto* const written = dynamic_cast<Parser::ArrayValueContext*>(&context)) {
    ast::ArrayLiteral array{{}, value_span(context)};
    for (Parser::NumberContext* const item : written->number()) array.items.push_back(number(item));
    return array;
  }
  ast::StructLiteral fields{{}, value_span(context)};
  for (auto* const item : context.getRuleContexts<Parser::ConstantFieldContext>()) {
    fields.fields.push_back({name(item->NAME(0)), name(item->NAME(1))});
  }
  return fields;
}

ast::StringLiteral LineTree::string(antlr4::tree::TerminalNode* node) {
  const antlr4::Token* const token = node->getSymbol();
  StringFault fault;
  auto decoded = read_string(text(token), fault);
  if (!decoded) {
    failed_ = true;
    const std::size_t begin = token->getStartIndex();
    report_
        .add(Code::R0302, line_.span(begin + fault.begin, begin + fault.end),
             "half of a surrogate pair in a string")
        .label("no character by itself")
        .help("characters beyond \\uffff are written as two escapes, \\ud800 to \\udbff first");
    decoded = std::string();
  }
  return {*std::move(decoded), span(token)};
}

// The opening brace comes with the blanks before it.
Span LineTree::value_span(const antlr4::ParserRuleContext& context) const {
  const std::size_t brace = context.start->getStopIndex();
  return line_.span(brace, context.stop->getStopIndex() + 1);
}

}  // namespace robdef::syntax
