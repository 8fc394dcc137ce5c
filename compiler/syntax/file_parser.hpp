// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/report.hpp"
#include "compiler/diagnostics/source.hpp"
#include "compiler/syntax/ast.hpp"
#include "compiler/syntax/earlier.hpp"
#include "compiler/syntax/line_parser.hpp"
#include "compiler/syntax/lines.hpp"
#include "compiler/syntax/parse.hpp"
#include "compiler/syntax/words.hpp"

namespace robdef::syntax {

/// Puts a file together from its lines: which statement may stand where, in which order, and what
/// belongs to which block. The form of a single line is LineParser's part.
class FileParser {
 public:
  /// With an earlier version of the text and what was read of it, which is used up, only what has
  /// changed is parsed.
  FileParser(const Source& source, SourceId id, Report& report,
             ast::EarlierFile* earlier = nullptr);

  /// May be called once.
  ast::File run();

 private:
  /// The parts of a file, in the order in which they have to stand.
  enum class Part { head, imports, usings, names, types };
  enum class BlockKind { none, record, object, enumeration };

  /// The block that is being read.
  struct Block {
    BlockKind kind = BlockKind::none;
    Keyword keyword = Keyword::none;
    Span header;       ///< its keyword
    std::string name;  ///< empty if the header was wrong
    ast::Record record;
    ast::Object object;
    ast::Enum enumeration;
    bool has_content = false;           ///< any line, even one that could not be read
    bool is_whole = true;               ///< no line was wrong
    std::optional<Span> first_member;   ///< field or member: its keyword
    std::optional<Span> missing_comma;  ///< the last enum value, when no comma follows it
  };

  void read_line();
  bool take_block();
  void mark_plain_lines();
  void keep_line(bool is_inside);
  void leave_comments_outside();
  void read_outside(Keyword keyword);
  void read_in_record(Keyword keyword);
  void read_in_object(Keyword keyword);
  void read_in_enum(Keyword keyword);

  void service();
  void stdver();
  void option();
  void import();
  void using_line();
  void exception();
  void constant();
  void open_block(Keyword keyword, bool has_name);
  void block_constant();
  void implements();
  void field();
  void member();
  void enum_values();
  void end();
  void close_block();
  void leave_block_open(std::optional<Span> next);
  void finish();

  void enter(Part part);
  bool is_too_late(Part part, Code code, std::string message);
  bool has_operand(Keyword keyword);
  bool cut_badly();
  void unknown_statement();
  bool explain_split_keyword();
  void misplaced(Keyword keyword);
  void outside_only(Keyword keyword);
  void stray(Keyword keyword);
  void declare_version(ast::VersionSpelling spelling, const VersionLine& version);
  [[nodiscard]] bool forbids_options() const;

  /// Reads the current line by a rule of the parser, unless it was read before.
  template <class Node>
  std::optional<Node> statement(std::optional<Node> (Earlier::*given)(const LogicalLine&,
                                                                      const ast::Line&),
                                std::optional<Node> (LineParser::*parsed)(const LogicalLine&,
                                                                          Report&)) {
    if (earlier_) {
      auto known = ((*earlier_).*given)(line_, reader_.written().back());
      if (known) return known;
    }
    return (parser_.*parsed)(line_, report());
  }

  /// Where findings on the current line go: nowhere if its text is damaged, which is reported.
  Report& report() { return line_.is_damaged() ? discarded_ : report_; }
  [[nodiscard]] std::string_view first_word() const;
  [[nodiscard]] Span first_word_span() const { return line_.span(0, first_word().size()); }
  [[nodiscard]] bool is_in_block() const { return block_.kind != BlockKind::none; }

  Report& report_;
  Report discarded_;
  std::optional<Earlier> earlier_;
  LineReader reader_;
  LineParser parser_;
  LogicalLine line_;
  ast::File file_;
  Block block_;
  Part part_ = Part::head;
  std::optional<Span> part_begin_[5];  ///< first statement of each part
  std::vector<Span> options_;          ///< accepted ones: their keywords
  bool wants_service_ = true;          ///< until the first statement
  bool expects_strays_ = false;        ///< after a block without an end
  // Of the statement that is being read.
  std::size_t first_line_ = 0;    ///< the line behind the statement before
  std::size_t first_remark_ = 0;  ///< remarks of the report until then
  bool is_plain_ = true;          ///< what it means does not depend on the file
};

}  // namespace robdef::syntax
