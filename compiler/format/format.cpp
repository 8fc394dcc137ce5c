// SPDX-License-Identifier: Apache-2.0
// Blank lines, comments, and the last line's end; statements are laid out in spacing.cpp.
#include "compiler/format/format.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "compiler/format/spacing.hpp"

namespace robdef::format {
namespace {

using ast::Line;
using ast::LineKind;

constexpr std::array<std::string_view, 5> block_words = {"enum", "struct", "pod", "namedarray",
                                                         "object"};

bool is_comment(const Line& line) {
  return line.kind == LineKind::comment || line.kind == LineKind::documentation;
}

class Layout {
 public:
  Layout(const ast::LosslessText& written, std::string_view text)
      : written_(written), lines_(written.lines), text_(text) {}

  std::vector<Edit> run() && {
    for (std::size_t index = 0; index < lines_.size();) {
      if (lines_[index].kind == LineKind::blank) {
        index = lay_out_blank_lines(index);
        continue;
      }
      if (wants_blank_line_above(index)) add_blank_line(index);
      lay_out_line(index);
      ++index;
    }
    end_last_line();
    return std::move(edits_);
  }

 private:
  void lay_out_line(std::size_t index) {
    const Line& line = lines_[index];
    if (line.kind == LineKind::statement) {
      lay_out_statement(written_, line, text_, edits_);
    } else if (is_comment(line)) {
      lay_out_comment(line, is_above_unread(index));
    }
  }

  // What a comment says is its writer's, so it only moves, with the statement below it.
  void lay_out_comment(const Line& line, bool stays) {
    const auto begin = static_cast<std::uint32_t>(text_.find('#', line.begin));
    if (!stays) put(line.begin, begin, indentation_of(line), Reason::indentation, text_, edits_);
    const std::uint32_t end = content_end(line, text_);
    std::uint32_t last = end;
    while (text_[last - 1] == ' ' || text_[last - 1] == '\t') --last;
    // A backslash that becomes the last character would continue the line, a carriage return end
    // it.
    const bool is_needed =
        text_[last - 1] == '\\' || text_[last - 1] == '\r' || is_of_several_lines(line);
    if (!is_needed) put(last, end, "", Reason::trailing_blanks, text_, edits_);
  }

  // Whether the next line that is neither blank nor a comment could not be read.
  bool is_above_unread(std::size_t index) {
    if (next_code_ <= index) {
      next_code_ = index + 1;
      while (next_code_ < lines_.size() &&
             (is_comment(lines_[next_code_]) || lines_[next_code_].kind == LineKind::blank)) {
        ++next_code_;
      }
    }
    return next_code_ < lines_.size() && lines_[next_code_].kind == LineKind::unread;
  }

  [[nodiscard]] bool is_of_several_lines(const Line& line) const {
    return text_.substr(line.begin, line.end - line.begin - 1).find('\n') != text_.npos;
  }

  // Of several blank lines one is kept; none at the ends of the file and of a block.
  std::size_t lay_out_blank_lines(std::size_t begin) {
    std::size_t end = begin;
    while (end < lines_.size() && lines_[end].kind == LineKind::blank) ++end;
    // Bytes that are a mistake here would be the mark of the file in its first line.
    const bool would_be_mark = begin == 0 && end < lines_.size() &&
                               text_.substr(lines_[end].begin).starts_with(byte_order_mark);
    if (would_be_mark) return end;
    const bool is_at_an_end = begin == 0 || end == lines_.size() || is_header(lines_[begin - 1]) ||
                              is_block_end(lines_[end]);
    std::size_t first_needless = begin;
    if (!is_at_an_end) {
      const Line& kept = lines_[begin];
      put(kept.begin, content_end(kept, text_), "", Reason::trailing_blanks, text_, edits_);
      ++first_needless;
    }
    if (first_needless < end) {
      put(lines_[first_needless].begin, lines_[end - 1].end, "", Reason::needless_blank_line, text_,
          edits_);
    }
    return end;
  }

  // Comments right above a statement belong to it, so the blank line goes above them.
  [[nodiscard]] bool wants_blank_line_above(std::size_t index) const {
    if (index == 0 || lines_[index - 1].kind != LineKind::statement) return false;
    std::size_t statement = index;
    while (statement < lines_.size() && is_comment(lines_[statement])) ++statement;
    if (statement == lines_.size() || lines_[statement].kind != LineKind::statement) return false;
    return are_apart(lines_[index - 1], lines_[statement]);
  }

  [[nodiscard]] bool are_apart(const Line& above, const Line& below) const {
    if (above.is_in_block || below.is_in_block) return false;
    if (is_header(above) || is_block_end(below)) return false;
    return is_block_end(above) || first_word(above) != first_word(below);
  }

  void add_blank_line(std::size_t index) {
    const Line& above = lines_[index - 1];
    const std::uint32_t place = lines_[index].begin;
    put(place, place, std::string(line_end(above)), Reason::missing_blank_line, text_, edits_);
  }

  [[nodiscard]] std::string_view line_end(const Line& line) const {
    const std::uint32_t end = content_end(line, text_);
    return text_.substr(end, line.end - end);
  }

  void end_last_line() {
    const auto last = std::find_if(lines_.rbegin(), lines_.rend(),
                                   [](const Line& line) { return line.kind != LineKind::blank; });
    if (last == lines_.rend() || last->kind == LineKind::unread) return;
    const std::uint32_t end = last->end;
    // A carriage return alone is a mistake, and none any more with a line feed behind it.
    if (text_[end - 1] == '\n' || text_[end - 1] == '\r') return;
    const bool is_first = last + 1 == lines_.rend();
    const std::string_view usual = is_first ? "\n" : line_end(*(last + 1));
    put(end, end, std::string(usual), Reason::missing_line_end, text_, edits_);
  }

  [[nodiscard]] std::string_view first_word(const Line& line) const {
    const auto tokens = written_.tokens_of(line);
    if (tokens.empty()) return {};
    return text_.substr(tokens.front().begin, tokens.front().end - tokens.front().begin);
  }
  [[nodiscard]] bool is_header(const Line& line) const {
    return !line.is_in_block &&
           std::find(block_words.begin(), block_words.end(), first_word(line)) != block_words.end();
  }
  [[nodiscard]] bool is_block_end(const Line& line) const {
    return !line.is_in_block && first_word(line) == "end";
  }

  const ast::LosslessText& written_;
  const std::vector<Line>& lines_;
  std::string_view text_;
  std::vector<Edit> edits_;
  std::size_t next_code_ = 0;  ///< line below the comments that are laid out
};

}  // namespace

std::string_view text_of(Reason reason) {
  switch (reason) {
    case Reason::indentation:
      return "indentation";
    case Reason::spacing:
      return "blanks between words";
    case Reason::trailing_blanks:
      return "blanks at the end of the line";
    case Reason::missing_blank_line:
      return "blank line missing above";
    case Reason::needless_blank_line:
      return "needless blank line";
    case Reason::missing_line_end:
      return "line end missing at the end of the file";
  }
  return {};
}

std::vector<Edit> edits(const ast::LosslessText& written, std::string_view text) {
  return Layout(written, text).run();
}

std::string with_edits(std::string_view text, const std::vector<Edit>& edits) {
  std::string result;
  std::size_t done = 0;
  for (const Edit& edit : edits) {
    result += text.substr(done, edit.begin - done);
    result += edit.replacement;
    done = edit.end;
  }
  result += text.substr(done);
  return result;
}

}  // namespace robdef::format
