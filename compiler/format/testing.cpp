// SPDX-License-Identifier: Apache-2.0
#include "compiler/format/testing.hpp"

#include <algorithm>

#include "compiler/format/format.hpp"
#include "compiler/syntax/parse.hpp"

namespace robdef::format::testing {
namespace {

bool is_white(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

std::string trimmed(std::string_view text) {
  while (!text.empty() && is_white(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_white(text.back())) text.remove_suffix(1);
  return std::string(text);
}

std::string_view part(std::string_view text, std::uint32_t begin, std::uint32_t end) {
  return text.substr(begin, end - begin);
}

// Blanks, and backslashes at the end of a line.
bool is_gap(std::string_view gap) {
  for (std::size_t at = 0; at < gap.size(); ++at) {
    if (is_white(gap[at])) continue;
    const std::size_t next = gap.find_first_not_of('\r', at + 1);
    if (gap[at] != '\\' || next == gap.npos || gap[next] != '\n') return false;
  }
  return true;
}

void keep_line(const Formatted& from, const ast::Line& line, Formatted& to) {
  const std::string_view text = part(from.text, line.begin, line.end);
  switch (line.kind) {
    case ast::LineKind::blank:
      return;
    case ast::LineKind::comment:
    case ast::LineKind::documentation:
      to.comments.push_back(std::string(ast::name_of(line.kind)) + ':' + trimmed(text));
      return;
    case ast::LineKind::statement:
      for (const ast::Token& token : from.file.written.tokens_of(line)) {
        to.tokens.push_back(std::string(ast::name_of(token.kind)) + ':' +
                            std::string(part(from.text, token.begin, token.end)));
      }
      return;
    case ast::LineKind::unread:
      to.unread.emplace_back(text);
  }
}

std::string joined(const std::vector<std::string>& texts) {
  std::string result;
  for (const std::string& text : texts) result += (result.empty() ? "" : " ") + text;
  return result;
}

}  // namespace

Formatted::Formatted(std::string written) : text(std::move(written)) {
  const SourceId id = sources.add("input.robdef", text);
  Report report;
  file = ast::parse(sources[id], id, report);
  for (const Diagnostic* diagnostic : report.sorted()) {
    codes.emplace_back(entry_of(diagnostic->code()).name);
  }
  for (const ast::Line& line : file.written.lines) keep_line(*this, line, *this);
  result = with_edits(text, edits(file.written, text));
}

std::string gap_in(const ast::LosslessText& written, std::string_view text) {
  std::uint32_t done = text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
  for (const ast::Line& line : written.lines) {
    if (line.begin != done || line.end <= line.begin) return "a gap between lines";
    std::uint32_t token_end = line.begin;
    for (const ast::Token& token : written.tokens_of(line)) {
      if (token.begin < token_end || token.end <= token.begin || token.end > line.end) {
        return "a token out of order";
      }
      if (!is_gap(part(text, token_end, token.begin))) return "text between tokens";
      token_end = token.end;
    }
    const bool has_tokens = line.token_count != 0;
    if (has_tokens != (line.kind == ast::LineKind::statement)) return "tokens of no statement";
    if (has_tokens && part(text, token_end, line.end).find('\\') == text.npos &&
        !is_gap(part(text, token_end, line.end))) {
      return "text behind the tokens";
    }
    if (line.kind == ast::LineKind::blank && !is_gap(part(text, line.begin, line.end))) {
      return "a blank line with text";
    }
    done = line.end;
  }
  return done == text.size() ? "" : "lines end early";
}

std::string without_blanks(std::string_view text) {
  std::string rest;
  std::copy_if(text.begin(), text.end(), std::back_inserter(rest),
               [](char c) { return !is_white(c); });
  return rest;
}

std::size_t comment_lines(std::string_view text) {
  std::size_t count = 0;
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    if (trimmed(text.substr(begin, end - begin)).starts_with('#')) ++count;
    begin = end + 1;
  }
  return count;
}

std::string fault_of_formatting(const Formatted& before) {
  const std::string& text = before.text;
  std::string gap = gap_in(before.file.written, text);
  if (!gap.empty()) return gap;
  const Formatted after(before.result);
  if (after.result != before.result) return "formatting it again changes more";
  if (without_blanks(before.result) != without_blanks(text)) return "more than blanks changed";
  if (comment_lines(before.result) != comment_lines(text)) return "a comment is lost";
  if (after.comments != before.comments) return "a comment changed";
  if (after.tokens != before.tokens) return "tokens changed";
  if (after.unread != before.unread) return "an unread line changed";
  if (after.codes != before.codes) {
    return "diagnostics changed: " + joined(before.codes) + " before, " + joined(after.codes);
  }
  return "";
}

}  // namespace robdef::format::testing
