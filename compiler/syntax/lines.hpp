// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/diagnostics/report.hpp"
#include "compiler/diagnostics/source.hpp"
#include "compiler/syntax/ast.hpp"

namespace robdef::syntax {

/// One statement: physical lines joined as 06, section 2 (L6) says, without blanks at either end.
/// Knows where each of its characters stands in the source.
class LogicalLine {
 public:
  /// Never empty. Valid until the reader goes on.
  [[nodiscard]] std::string_view text() const { return text_; }
  /// The `##` lines above it.
  [[nodiscard]] const ast::Documentation& documentation() const { return documentation_; }
  /// Whether it holds bytes that are not allowed and have been reported. They read as `x` when they
  /// stand for a letter beyond ASCII, else as blanks.
  [[nodiscard]] bool is_damaged() const { return is_damaged_; }

  /// Where a part of the text stands in the source, from offset to offset.
  [[nodiscard]] Span span(std::size_t begin, std::size_t end) const;
  [[nodiscard]] Span span() const { return span(0, text_.size()); }

  /// Whether the character at this offset is a blank that stands for a backslash.
  [[nodiscard]] bool is_joint(std::size_t offset) const;

 private:
  friend class LineReader;
  /// Characters from `begin` on come from `source` on, up to the next piece.
  struct Piece {
    std::uint32_t begin = 0;
    std::uint32_t source = 0;
  };
  [[nodiscard]] std::uint32_t source_offset(std::size_t offset) const;

  SourceId source_{};
  std::string_view text_;
  std::uint32_t text_offset_ = 0;  ///< of text_ in the joined line that the pieces describe
  std::vector<Piece> pieces_;
  ast::Documentation documentation_;
  bool is_damaged_ = false;
};

/// Reads a source line by line: joins continued lines, leaves out comments and empty lines,
/// collects documentation, and tells the report what comments allow. Reports L1 to L4, Q22 and
/// R0146.
class LineReader {
 public:
  /// The source must outlive the reader and the lines.
  LineReader(const Source& source, SourceId id, Report& report);

  /// Reads the next statement; false at the end. Inside a block a `##` line can be continued.
  bool next(bool is_in_block, LogicalLine& line);

  /// Leaves out one physical line: the intended second half of a statement that was cut badly. It
  /// becomes part of that statement's line.
  void skip_physical_line();

  /// Goes on behind lines that are known; `offset` is where a line begins.
  void skip_to(std::uint32_t offset) { next_ = offset; }

  /// All lines up to the statement that was read last, each statement as LineKind::unread.
  [[nodiscard]] std::vector<ast::Line>& written() { return written_; }

 private:
  /// A physical line without its end.
  struct Physical {
    std::string_view text;
    std::uint32_t offset = 0;  ///< of text in the source
    bool is_damaged = false;
  };

  [[nodiscard]] bool at_end() const { return next_ >= text_.size(); }
  Physical read_physical();
  void check_bytes(Physical& physical);
  void report_byte(const Physical& physical, std::size_t at);
  void read_comment(Physical physical, bool is_in_block);
  void read_remark(const Physical& physical);
  void read_allowed(std::string_view codes, std::uint32_t begin);
  void end_allows();
  void keep(ast::LineKind kind, bool is_in_block, std::uint32_t begin);
  void join(Physical physical, LogicalLine& line);
  void append(const Physical& physical, LogicalLine& line);

  std::string_view text_;
  SourceId id_;
  Report& report_;
  std::size_t next_ = 0;
  std::string joined_;    ///< text of a line that had to be copied
  std::string repaired_;  ///< text of a physical line without its bad bytes
  ast::Documentation documentation_;
  bool has_documentation_ = false;
  bool blank_after_documentation_ = false;
  std::vector<ast::Line> written_;
  /// Codes of comments since the last statement, at their places.
  std::vector<std::pair<Code, Span>> allows_;
};

}  // namespace robdef::syntax
