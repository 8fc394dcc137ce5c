// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string_view>

#include "compiler/lsp/symbols.hpp"
#include "compiler/syntax/words.hpp"

namespace robdef::lsp {
namespace {

enum class TokenType : unsigned {
  name_space,
  type,
  enumeration,
  interface,
  record,
  parameter,
  property,
  enum_member,
  event,
  method,
  variable,
  keyword,
  modifier,
  comment,
  text,
  number,
};
constexpr std::array type_names = {"namespace", "type",      "enum",     "interface",
                                   "struct",    "parameter", "property", "enumMember",
                                   "event",     "method",    "variable", "keyword",
                                   "modifier",  "comment",   "string",   "number"};

struct TokenModifier {
  static constexpr unsigned none = 0;
  static constexpr unsigned declaration = 1;
  static constexpr unsigned documentation = 2;
  static constexpr unsigned built_in = 4;
  static constexpr unsigned fixed = 8;
};
constexpr std::array modifier_names = {"declaration", "documentation", "defaultLibrary",
                                       "readonly"};

TokenType type_of(const Symbol& symbol) {
  switch (symbol.kind) {
    case SymbolKind::service:
      return TokenType::name_space;
    case SymbolKind::alias:
      return symbol.target == nullptr ? TokenType::type : type_of(*symbol.target);
    case SymbolKind::constant:
      return TokenType::variable;
    case SymbolKind::exception:
      return TokenType::type;
    case SymbolKind::enumeration:
      return TokenType::enumeration;
    case SymbolKind::enum_value:
      return TokenType::enum_member;
    case SymbolKind::record:
      return TokenType::record;
    case SymbolKind::object:
      return TokenType::interface;
    case SymbolKind::field:
      return TokenType::property;
    case SymbolKind::parameter:
      return TokenType::parameter;
    case SymbolKind::member:
      break;
  }
  if (symbol.word == "function" || symbol.word == "callback") return TokenType::method;
  return symbol.word == "event" ? TokenType::event : TokenType::property;
}

/// Writes tokens as differences of their places.
class Encoder {
 public:
  Encoder(const Analysis& analysis, Encoding encoding)
      : analysis_(analysis), text_(analysis.text()), encoding_(encoding) {}

  Json run() {
    const ast::LosslessText& written = analysis_.file().written;
    for (const ast::Line& line : written.lines) {
      if (line.kind == ast::LineKind::comment) add_lines(line, TokenModifier::none);
      if (line.kind == ast::LineKind::documentation) add_lines(line, TokenModifier::documentation);
      bool is_modifier = false;
      for (const ast::Token& token : written.tokens_of(line)) {
        if (token.kind == ast::TokenKind::open_modifiers) is_modifier = true;
        if (token.kind == ast::TokenKind::open_arguments) is_modifier = false;
        if (token.kind == ast::TokenKind::close_arguments) is_modifier = true;
        add_token(token, is_modifier);
      }
    }
    return std::move(data_);
  }

 private:
  void add(std::uint32_t begin, std::uint32_t end, TokenType type, unsigned modifiers) {
    const Range range = text_.range({SourceId{}, begin, end}, encoding_);
    // One that is broken over lines is left to the editor's own colours.
    if (range.start.line != range.end.line || range.start == range.end) return;
    const std::uint32_t lines = range.start.line - last_.line;
    const std::uint32_t characters =
        lines == 0 ? range.start.character - last_.character : range.start.character;
    for (const std::uint32_t part : {lines, characters, range.end.character - range.start.character,
                                     static_cast<std::uint32_t>(type), modifiers}) {
      data_.push_back(part);
    }
    last_ = range.start;
  }

  // A comment may be continued.
  void add_lines(const ast::Line& line, unsigned modifiers) {
    for (std::uint32_t begin = line.begin; begin < line.end;) {
      const std::size_t found = text_.bytes().find('\n', begin);
      const std::uint32_t end = std::min<std::uint32_t>(
          line.end, found == std::string::npos ? line.end : static_cast<std::uint32_t>(found) + 1);
      std::uint32_t first = begin;
      while (first < end && syntax::is_blank(text_.bytes()[first])) ++first;
      // The place of an end behind the line is the line's.
      const std::uint32_t number = text_.place(first, encoding_).line;
      const auto size = static_cast<std::uint32_t>(text_.line(number).size());
      const std::uint32_t line_begin = text_.offset({number, 0}, encoding_);
      if (first < line_begin + size) add(first, line_begin + size, TokenType::comment, modifiers);
      begin = end;
    }
  }

  void add_token(const ast::Token& token, bool is_modifier) {
    switch (token.kind) {
      case ast::TokenKind::keyword:
        return add(token.begin, token.end, TokenType::keyword, TokenModifier::none);
      case ast::TokenKind::number:
      case ast::TokenKind::version:
        return add(token.begin, token.end, TokenType::number, TokenModifier::none);
      case ast::TokenKind::string:
      case ast::TokenKind::text:
        return add(token.begin, token.end, TokenType::text, TokenModifier::none);
      case ast::TokenKind::name:
        return add_name(token, is_modifier);
      default:
        return;
    }
  }

  void add_name(const ast::Token& token, bool is_modifier) {
    const auto& all = analysis_.index().occurrences();
    while (next_ < all.size() && all[next_].span.begin < token.begin) ++next_;
    if (next_ < all.size() && all[next_].span.begin < token.end) {
      for (; next_ < all.size() && all[next_].span.begin < token.end; ++next_) {
        const Occurrence& one = all[next_];
        const unsigned modifiers =
            (one.is_declaration ? TokenModifier::declaration : TokenModifier::none) |
            (one.symbol->kind == SymbolKind::constant ? TokenModifier::fixed : TokenModifier::none);
        add(one.span.begin, one.span.end, type_of(*one.symbol), modifiers);
      }
      return;
    }
    const std::string_view word =
        std::string_view(text_.bytes()).substr(token.begin, token.end - token.begin);
    if (is_modifier) {
      add(token.begin, token.end, TokenType::modifier, TokenModifier::none);
    } else if (syntax::is_built_in_type(word)) {
      add(token.begin, token.end, TokenType::type, TokenModifier::built_in);
    }
  }

  const Analysis& analysis_;
  const Text& text_;
  const Encoding encoding_;
  Json data_ = Json::array();
  Place last_;
  std::size_t next_ = 0;  // of the occurrences
};

}  // namespace

Json semantic_legend() { return {{"tokenTypes", type_names}, {"tokenModifiers", modifier_names}}; }

Json semantic_tokens(const Analysis& analysis, Encoding encoding) {
  return {{"data", Encoder(analysis, encoding).run()}};
}

}  // namespace robdef::lsp
