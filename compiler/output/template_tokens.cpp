// SPDX-License-Identifier: Apache-2.0
#include "compiler/output/template_tokens.hpp"

#include <algorithm>
#include <utility>

#include "compiler/output/template.hpp"

namespace robdef {
namespace {

using Token = TemplateToken;

bool is_blank(std::string_view text) {
  return text.find_first_not_of(" \t") == std::string_view::npos;
}

std::string_view trim(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

std::size_t lines_in(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count(text, '\n'));
}

class Scanner {
 public:
  Scanner(std::string_view name, std::string_view source) : name_(name), source_(source) {}

  std::vector<Token> scan() {
    while (true) {
      std::size_t open = source_.find("{{", at_);
      if (open == std::string_view::npos) break;
      // Of more braces the last two: the others are text.
      while (open + 2 < source_.size() && source_[open + 2] == '{') ++open;
      const std::size_t close = source_.find("}}", open);
      if (close == std::string_view::npos) {
        throw TemplateError(name_, line_ + lines_in(source_.substr(at_, open - at_)),
                            "`{{` without `}}`");
      }
      tag(open, close + 2);
    }
    text(source_.size());
    return std::move(tokens_);
  }

 private:
  void text(std::size_t end) {
    const std::string_view piece = source_.substr(at_, end - at_);
    if (!piece.empty()) tokens_.push_back({.text = piece, .line = line_});
    line_ += lines_in(piece);
    at_ = end;
  }

  void tag(std::size_t begin, std::size_t end) {
    std::string_view inside = source_.substr(begin + 2, end - begin - 4);
    const char sign = inside.empty() ? ' ' : inside.front();
    const bool is_value = std::string_view("#^/>!").find(sign) == std::string_view::npos;
    const std::size_t line_begin = source_.rfind('\n', begin) + 1;  // npos + 1 is 0
    const std::string_view before = source_.substr(line_begin, begin - line_begin);
    const std::size_t line_end = std::min(source_.find('\n', end), source_.size());
    const bool is_alone = !is_value && line_begin >= at_ && is_blank(before) &&
                          is_blank(source_.substr(end, line_end - end));
    text(is_alone ? line_begin : begin);
    if (!is_value) inside.remove_prefix(1);
    if (sign != '!') {
      tokens_.push_back({.kind = kind_of(sign),
                         .text = trim(inside),
                         .line = line_,
                         .indent = is_alone ? before : std::string_view(),
                         .is_alone = is_alone});
    }
    const std::size_t next = is_alone ? std::min(line_end + 1, source_.size()) : end;
    line_ += lines_in(source_.substr(at_, next - at_));
    at_ = next;
  }

  static Token::Kind kind_of(char sign) {
    switch (sign) {
      case '#':
        return Token::Kind::open;
      case '^':
        return Token::Kind::inverted;
      case '/':
        return Token::Kind::close;
      case '>':
        return Token::Kind::partial;
      default:
        return Token::Kind::value;
    }
  }

  std::string_view name_;
  std::string_view source_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
  std::vector<Token> tokens_;
};

}  // namespace

std::vector<TemplateToken> scan_template(std::string_view name, std::string_view source) {
  return Scanner(name, source).scan();
}

}  // namespace robdef
