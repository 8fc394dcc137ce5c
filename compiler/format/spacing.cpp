// SPDX-License-Identifier: Apache-2.0
// Blanks inside of statements.
#include "compiler/format/spacing.hpp"

#include <algorithm>
#include <utility>

namespace robdef::format {
namespace {

using ast::Token;
using ast::TokenKind;

constexpr std::string_view one_level = "    ";

bool is_closing(TokenKind kind) {
  return kind == TokenKind::close_parameters || kind == TokenKind::close_array ||
         kind == TokenKind::close_container || kind == TokenKind::close_modifiers ||
         kind == TokenKind::close_arguments || kind == TokenKind::close_value;
}

bool is_opening(TokenKind kind) {
  return kind == TokenKind::open_parameters || kind == TokenKind::open_array ||
         kind == TokenKind::open_container || kind == TokenKind::open_modifiers ||
         kind == TokenKind::open_arguments || kind == TokenKind::open_value;
}

// Never with a blank before it.
bool is_attached(TokenKind kind) {
  return kind == TokenKind::comma || kind == TokenKind::colon ||
         kind == TokenKind::open_parameters || kind == TokenKind::open_array ||
         kind == TokenKind::open_container || kind == TokenKind::open_arguments || is_closing(kind);
}

/// Walks over the tokens of a line and knows in which brackets it is.
class Spacing {
 public:
  // Whether a blank stands between a token and the next one.
  bool is_blank_between(const Token& token, TokenKind next) {
    enter(token.kind);
    if (in_array_ || is_attached(next) || is_opening(token.kind)) return false;
    return token.kind != TokenKind::comma || !in_modifiers_ || in_arguments_;
  }

 private:
  void enter(TokenKind kind) {
    if (kind == TokenKind::open_array || kind == TokenKind::close_array) {
      in_array_ = kind == TokenKind::open_array;
    } else if (kind == TokenKind::open_modifiers) {
      in_modifiers_ = true;
    } else if (kind == TokenKind::open_arguments || kind == TokenKind::close_arguments) {
      in_arguments_ = kind == TokenKind::open_arguments;
    }
  }

  bool in_array_ = false;
  bool in_modifiers_ = false;
  bool in_arguments_ = false;
};

/// One statement.
class Statement {
 public:
  Statement(std::span<const Token> tokens, const ast::Line& line, std::string_view text,
            std::vector<Edit>& edits)
      : tokens_(tokens), line_(line), text_(text), edits_(edits) {}

  void run() {
    if (is_delicate()) return;
    const std::string indentation = indentation_of(line_);
    put(line_.begin, tokens_.front().begin, indentation, Reason::indentation, text_, edits_);
    Spacing spacing;
    for (std::size_t next = 1; next < tokens_.size(); ++next) {
      const bool is_blank = spacing.is_blank_between(tokens_[next - 1], tokens_[next].kind);
      if (next == 1 || !is_option()) lay_out_gap(next, is_blank);
    }
    put(tokens_.back().end, content_end(line_, text_), "", Reason::trailing_blanks, text_, edits_);
  }

 private:
  [[nodiscard]] std::string_view between(std::uint32_t begin, std::uint32_t end) const {
    return text_.substr(begin, end - begin);
  }
  [[nodiscard]] std::string_view gap_before(std::size_t next) const {
    return between(tokens_[next - 1].end, tokens_[next].begin);
  }

  // What follows `option` is kept as it is.
  [[nodiscard]] bool is_option() const {
    return between(tokens_.front().begin, tokens_.front().end) == "option";
  }

  // A continuation before the first or behind the last token joins nothing; exactly one blank may
  // follow `as`, and a continuation is one.
  [[nodiscard]] bool is_delicate() const {
    const auto continues = [](std::string_view gap) { return gap.find('\\') != gap.npos; };
    if (continues(between(line_.begin, tokens_.front().begin))) return true;
    if (continues(between(tokens_.back().end, line_.end))) return true;
    for (std::size_t next = 2; next < tokens_.size(); ++next) {
      if (tokens_[next - 1].kind == TokenKind::keyword && continues(gap_before(next))) return true;
    }
    return false;
  }

  void lay_out_gap(std::size_t next, bool is_blank) {
    const std::string_view gap = gap_before(next);
    std::string wanted = is_blank ? " " : "";
    for (std::size_t at = gap.find('\\'); at != gap.npos; at = gap.find('\\', at)) {
      const std::size_t end = gap.find('\n', at) + 1;
      wanted += gap.substr(at, end - at);
      wanted += indentation_of(line_);
      wanted += one_level;
      at = end;
    }
    put(tokens_[next - 1].end, tokens_[next].begin, std::move(wanted), Reason::spacing, text_,
        edits_);
  }

  std::span<const Token> tokens_;
  const ast::Line& line_;
  std::string_view text_;
  std::vector<Edit>& edits_;
};

}  // namespace

std::string indentation_of(const ast::Line& line) {
  return std::string(line.is_in_block ? one_level : std::string_view());
}

std::uint32_t content_end(const ast::Line& line, std::string_view text) {
  std::uint32_t end = line.end;
  if (end > line.begin && text[end - 1] == '\n') --end;
  if (end == line.end) return end;
  while (end > line.begin && text[end - 1] == '\r') --end;
  return end;
}

void put(std::uint32_t begin, std::uint32_t end, std::string replacement, Reason reason,
         std::string_view text, std::vector<Edit>& edits) {
  if (text.substr(begin, end - begin) == replacement) return;
  edits.push_back({begin, end, std::move(replacement), reason});
}

void lay_out_statement(const ast::LosslessText& written, const ast::Line& line,
                       std::string_view text, std::vector<Edit>& edits) {
  Statement(written.tokens_of(line), line, text, edits).run();
}

}  // namespace robdef::format
