// SPDX-License-Identifier: Apache-2.0
#include "compiler/docs/markdown_markup.hpp"

#include <cctype>
#include <cstddef>

#include "compiler/docs/html_markup.hpp"

namespace robdef::docs {
namespace {

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; }

/// Whether the character at `at` would begin a heading, list, quotation or underline of a heading.
bool is_mark_of_line(std::string_view raw, std::size_t at) {
  const char c = raw[at];
  const std::string_view before = raw.substr(0, at);
  const std::size_t line = before.find_last_of('\n') + 1;  // npos + 1 is 0
  const std::string_view begin = before.substr(line);
  if (c == '+' || c == '-' || c == '=') return begin.find_first_not_of(" \t+-=") == begin.npos;
  if (c != '.' && c != ')') return false;
  const std::size_t digit = begin.find_first_not_of(" \t");
  return digit != begin.npos && begin.find_first_not_of("0123456789", digit) == begin.npos;
}

void append_markdown(std::string& text, std::string_view raw, std::size_t at) {
  const char c = raw[at];
  const char before = at == 0 ? ' ' : raw[at - 1];
  const char after = at + 1 == raw.size() ? ' ' : raw[at + 1];
  if (std::string_view("\\`*[]~#").find(c) != std::string_view::npos) {
    text += '\\';
    text += c;
  } else if (c == '|') {
    text += "&#124;";
  } else if (c == '$') {
    text += "&#36;";
  } else if (c == '{' && (after == '{' || after == '%' || after == '#')) {
    text += "&#123;";
  } else if (c == '_' && !(is_word(before) && is_word(after))) {
    text += "\\_";
  } else if (is_mark_of_line(raw, at)) {
    text += '\\';
    text += c;
  } else if (c == '\t') {
    text += ' ';
  } else if (c == '"' || c == '\'') {
    text += c;  // read as it is, and in no attribute
  } else {
    text += html_text(raw.substr(at, 1));
  }
}

void append_lines(std::vector<std::string>& lines, std::string_view text) {
  while (true) {
    const std::size_t end = text.find('\n');
    lines.emplace_back(text.substr(0, end));
    if (end == text.npos) return;
    text.remove_prefix(end + 1);
  }
}

// GitHub reads no Markdown in <pre>. Others do, and templates of page generators are read anywhere.
std::string verbatim_markdown(const Block& block) {
  std::string text;
  for (const char c : verbatim_html(block)) {
    if (std::string_view("[]`*_{|$~\\").find(c) == std::string_view::npos) {
      text += c;
    } else {
      text += "&#" + std::to_string(static_cast<int>(c)) + ';';
    }
  }
  return text;
}

}  // namespace

std::string MarkdownMarkup::text(std::string_view raw) const {
  std::string text;
  for (std::size_t at = 0; at < raw.size(); ++at) append_markdown(text, raw, at);
  return text;
}

std::string MarkdownMarkup::name(std::string_view raw, std::string_view /*address*/) const {
  return "<b>" + text(raw) + "</b>";
}

std::string MarkdownMarkup::link(std::string_view label, std::string_view address) const {
  return "[" + std::string(label) + "](" + html_text(address) + ")";
}

std::vector<std::string> MarkdownMarkup::lines(const std::vector<Block>& blocks) const {
  std::vector<std::string> lines;
  for (const Block& block : blocks) {
    if (!lines.empty()) lines.emplace_back();
    if (block.kind == BlockKind::verbatim) {
      append_lines(lines, verbatim_markdown(block));
      continue;
    }
    for (std::size_t i = 0; i < block.lines.size(); ++i) {
      std::string mark;
      if (block.kind == BlockKind::bullets) mark = "- ";
      if (block.kind == BlockKind::numbers) mark = std::to_string(i + 1) + ". ";
      lines.push_back(mark + prose(block.lines[i]));
    }
  }
  return lines;
}

}  // namespace robdef::docs
