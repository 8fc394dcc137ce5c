// SPDX-License-Identifier: Apache-2.0
// Makes logical lines of physical ones. Reads bytes; reports R0101 (characters), R0102 (NUL), R0103
// (carriage returns), R0104 (a continuation with nothing to join), R0145 (documentation that
// swallows a line), R0146 (a comment for us that is not understood).
#include "compiler/syntax/lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "compiler/syntax/words.hpp"

namespace robdef::syntax {
namespace {

constexpr bool is_allowed(char c) { return (c >= ' ' && c <= '~') || c == '\t'; }
constexpr bool is_beyond_ascii(char c) { return static_cast<unsigned char>(c) >= 0x80; }

std::string_view without_leading_blanks(std::string_view text) {
  const auto first = std::find_if_not(text.begin(), text.end(), is_blank);
  return text.substr(static_cast<std::size_t>(first - text.begin()));
}

std::string_view without_trailing_blanks(std::string_view text) {
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

// Of a comment as it stands in the file. One that follows a byte that is no blank is not
// understood.
ast::LineKind comment_kind(std::string_view written) {
  const std::string_view text = without_leading_blanks(written);
  if (!text.starts_with('#')) return ast::LineKind::unread;
  return text.starts_with("##") ? ast::LineKind::documentation : ast::LineKind::comment;
}

}  // namespace

std::uint32_t LogicalLine::source_offset(std::size_t offset) const {
  const auto joined = static_cast<std::uint32_t>(offset) + text_offset_;
  auto piece = std::upper_bound(pieces_.begin(), pieces_.end(), joined,
                                [](std::uint32_t at, const Piece& p) { return at < p.begin; });
  --piece;
  return piece->source + (joined - piece->begin);
}

Span LogicalLine::span(std::size_t begin, std::size_t end) const {
  const std::uint32_t first = source_offset(begin);
  // The last character decides, because what follows it may come from another physical line.
  const std::uint32_t last = end > begin ? source_offset(end - 1) + 1 : first;
  return {source_, first, last};
}

bool LogicalLine::is_joint(std::size_t offset) const {
  const auto joined = static_cast<std::uint32_t>(offset) + text_offset_;
  return std::any_of(pieces_.begin() + 1, pieces_.end(),
                     [joined](const Piece& piece) { return piece.begin == joined + 1; });
}

LineReader::LineReader(const Source& source, SourceId id, Report& report)
    : text_(source.text()), id_(id), report_(report) {
  if (text_.starts_with(byte_order_mark)) next_ = byte_order_mark.size();
}

bool LineReader::next(bool is_in_block, LogicalLine& line) {
  while (!at_end()) {
    const Physical physical = read_physical();
    const std::string_view content = without_leading_blanks(physical.text);
    const std::uint32_t begin = physical.offset;
    if (content.empty()) {
      blank_after_documentation_ = has_documentation_;
      keep(physical.is_damaged ? ast::LineKind::unread : ast::LineKind::blank, is_in_block, begin);
    } else if (content.front() == '#') {
      const auto kind = comment_kind(text_.substr(begin, physical.text.size()));
      read_comment(physical, is_in_block);
      keep(kind, is_in_block, begin);
    } else {
      join(physical, line);
      keep(ast::LineKind::unread, is_in_block, begin);
      if (line.text_.empty()) continue;
      line.documentation_ = std::exchange(documentation_, {});
      has_documentation_ = blank_after_documentation_ = false;
      end_allows();
      return true;
    }
  }
  end_allows();
  return false;
}

/// What was allowed above the statement that ends where reading goes on.
void LineReader::end_allows() {
  for (const auto& [code, comment] : allows_) {
    report_.allow_at(code, {id_, comment.begin, static_cast<std::uint32_t>(next_)}, comment);
  }
  allows_.clear();
}

void LineReader::skip_physical_line() {
  if (!at_end()) read_physical();
  if (!written_.empty()) written_.back().end = static_cast<std::uint32_t>(next_);
}

// The line that ends where reading goes on.
void LineReader::keep(ast::LineKind kind, bool is_in_block, std::uint32_t begin) {
  written_.push_back({kind, is_in_block, false, begin, static_cast<std::uint32_t>(next_), 0, 0});
}

LineReader::Physical LineReader::read_physical() {
  const std::size_t begin = next_;
  const char* const start = text_.data() + begin;
  const void* const found = std::memchr(start, '\n', text_.size() - begin);
  std::size_t end = text_.size();
  if (found != nullptr) {
    end = begin + static_cast<std::size_t>(static_cast<const char*>(found) - start);
    next_ = end + 1;
    while (end > begin && text_[end - 1] == '\r') --end;
  } else {
    next_ = end;
  }
  Physical physical{text_.substr(begin, end - begin), static_cast<std::uint32_t>(begin), false};
  check_bytes(physical);
  return physical;
}

void LineReader::check_bytes(Physical& physical) {
  // No early exit, so that the compiler makes vector code of it: every byte of every file passes.
  unsigned bad = 0;
  for (const char c : physical.text) bad |= static_cast<unsigned>(!is_allowed(c));
  if (bad == 0) return;
  physical.is_damaged = true;
  repaired_.assign(physical.text);
  bool is_reported = false;
  for (std::size_t at = 0; at < repaired_.size(); ++at) {
    const char c = repaired_[at];
    if (is_allowed(c)) continue;
    if (!is_reported) report_byte(physical, at);
    is_reported = true;
    repaired_[at] = is_beyond_ascii(c) ? 'x' : ' ';
  }
  physical.text = repaired_;
}

void LineReader::report_byte(const Physical& physical, std::size_t at) {
  const std::string_view text = text_.substr(physical.offset, physical.text.size());
  const auto begin = static_cast<std::uint32_t>(physical.offset + at);
  const char c = text[at];
  if (c == '\0') {
    report_.add(Code::R0102, {id_, begin, begin + 1}, "a NUL byte in the text")
        .help("save the file as plain text in ASCII or UTF-8");
  } else if (c == '\r') {
    report_.add(Code::R0103, {id_, begin, begin + 1}, "a carriage return that does not end a line")
        .help("save the file with LF or CR LF line ends");
  } else if (is_beyond_ascii(c)) {
    std::size_t end = at;
    while (end < text.size() && is_beyond_ascii(text[end])) ++end;
    report_
        .add(Code::R0101, {id_, begin, static_cast<std::uint32_t>(physical.offset + end)},
             "a character that is not ASCII")
        .label("only the characters from blank to `~` and the tab can be used")
        .help("inside a string constant, write an escape such as \"\\u00e9\"");
  } else {
    report_
        .add(Code::R0101, {id_, begin, begin + 1},
             fmt::format("a control character, number {} of ASCII", static_cast<int>(c)))
        .label("only the characters from blank to `~` and the tab can be used");
  }
}

void LineReader::read_comment(Physical physical, bool is_in_block) {
  std::string text(without_leading_blanks(physical.text));
  if (!text.starts_with("##")) {
    documentation_.clear();
    has_documentation_ = blank_after_documentation_ = false;
    read_remark(physical);
    return;
  }
  while (is_in_block && text.ends_with('\\') && !at_end()) {
    const auto backslash = static_cast<std::uint32_t>(physical.offset + physical.text.size()) - 1;
    report_
        .add(Code::R0145, {id_, backslash, backslash + 1},
             "documentation that swallows the next line")
        .label("joins the next line to the documentation")
        .help("remove the backslash");
    physical = read_physical();
    text.back() = ' ';
    text += physical.text;
  }
  if (blank_after_documentation_) documentation_.clear();
  if (has_documentation_ && !blank_after_documentation_) documentation_ += '\n';
  std::string_view content = std::string_view(text).substr(2);
  if (content.starts_with(' ')) content.remove_prefix(1);
  documentation_ += without_trailing_blanks(content);
  has_documentation_ = true;
  blank_after_documentation_ = false;
}

/// `# robdef: allow R0610`; any other comment is none of ours.
void LineReader::read_remark(const Physical& physical) {
  constexpr std::string_view address = "robdef:";
  const std::string_view text = physical.text;
  const std::size_t first = text.find_first_not_of(" \t", text.find('#') + 1);
  if (first == std::string_view::npos || !text.substr(first).starts_with(address)) return;
  const std::size_t word = text.find_first_not_of(" \t", first + address.size());
  constexpr std::string_view allow = "allow";
  const std::string_view rest = word == std::string_view::npos ? "" : text.substr(word);
  const auto begin = static_cast<std::uint32_t>(physical.offset + first);
  if (rest.starts_with(allow) && (rest.size() == allow.size() || is_blank(rest[allow.size()]))) {
    const std::size_t codes = word + allow.size();
    read_allowed(text.substr(codes), static_cast<std::uint32_t>(physical.offset + codes));
    return;
  }
  const auto end = static_cast<std::uint32_t>(physical.offset + text.size());
  report_.add(Code::R0146, {id_, begin, end}, "a comment for robdef that is not understood")
      .label("only `allow` can be here")
      .help("write `# robdef: allow` and codes of warnings, such as R0610");
}

void LineReader::read_allowed(std::string_view codes, std::uint32_t begin) {
  bool is_empty = true;
  for (std::size_t at = 0; at < codes.size();) {
    const std::size_t end = std::min(codes.find_first_of(" \t,", at), codes.size());
    const std::string_view name = codes.substr(at, end - at);
    const Span span{id_, begin + static_cast<std::uint32_t>(at),
                    begin + static_cast<std::uint32_t>(end)};
    at = end + 1;
    if (name.empty()) continue;
    is_empty = false;
    const CodeEntry* const entry = find_code(name);
    if (entry == nullptr) {
      report_.add(Code::R0146, span, fmt::format("there is no code `{}`", name))
          .help("`robdef explain --list` shows all");
    } else if (entry->severity == Severity::error) {
      report_.add(Code::R0146, span, fmt::format("`{}` cannot be allowed", name)).label("an error");
    } else {
      allows_.emplace_back(entry->code, span);
    }
  }
  if (!is_empty) return;
  report_.add(Code::R0146, {id_, begin, begin}, "a comment for robdef that allows nothing")
      .help("write codes of warnings behind `allow`, such as R0610");
}

void LineReader::join(Physical physical, LogicalLine& line) {
  line.source_ = id_;
  line.pieces_.assign(1, {0, physical.offset});
  line.is_damaged_ = physical.is_damaged;
  std::string_view text = physical.text;
  if (text.ends_with('\\') || physical.is_damaged) {
    // The copy is needed: the text is put together, or the buffer of repaired_ is used again.
    joined_.clear();
    line.pieces_.clear();
    append(physical, line);
    while (joined_.ends_with('\\')) {
      if (at_end()) {
        const auto backslash =
            static_cast<std::uint32_t>(physical.offset + physical.text.size()) - 1;
        report_.add(Code::R0104, {id_, backslash, backslash + 1}, "a continuation on the last line")
            .label("there is no next line")
            .help("remove the backslash");
        joined_.pop_back();
        break;
      }
      joined_.back() = ' ';
      physical = read_physical();
      append(physical, line);
    }
    text = joined_;
  }
  const std::string_view content = without_leading_blanks(text);
  line.text_offset_ = static_cast<std::uint32_t>(text.size() - content.size());
  line.text_ = without_trailing_blanks(content);
}

void LineReader::append(const Physical& physical, LogicalLine& line) {
  line.pieces_.push_back({static_cast<std::uint32_t>(joined_.size()), physical.offset});
  line.is_damaged_ = line.is_damaged_ || physical.is_damaged;
  joined_ += physical.text;
}

}  // namespace robdef::syntax
