// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "compiler/syntax/ast.hpp"
#include "compiler/syntax/line_parser.hpp"
#include "compiler/syntax/lines.hpp"
#include "compiler/syntax/shift.hpp"

namespace robdef::syntax {

/// What was read of an earlier version of a text. Gives what stands at the begin and end that both
/// versions have in common, so that only what was changed between them is parsed. Lines are given
/// only if they are plain (ast::Line); each part once, because it moves.
class Earlier {
 public:
  /// All that is passed must outlive the object.
  Earlier(std::string_view earlier_text, ast::File& earlier, std::string_view text,
          SourceId source);

  /// A whole block, from its first line to `end`.
  struct Block {
    ast::Declaration declaration;
    std::span<const ast::Line> lines;  ///< as they were; the first is that of the header
    Shift shift;
  };
  /// The block whose first line begins here.
  std::optional<Block> block(std::uint32_t begin);

  /// The statement on the line from `begin` to `end`, of a block or outside, without its
  /// documentation. Nothing when there was another statement, or something else to say of it.
  std::optional<ast::Field> field(const LogicalLine& line, const ast::Line& written);
  std::optional<ast::Member> member(const LogicalLine& line, const ast::Line& written);
  std::optional<ast::Constant> constant(const LogicalLine& line, const ast::Line& written);
  std::optional<EnumLine> enum_line(const LogicalLine& line, const ast::Line& written);

  /// Adds the tokens of an earlier line.
  void append_tokens(const ast::Line& line, const Shift& by, std::vector<ast::Token>& tokens) const;
  /// Adds the tokens of the statement that was given last, and returns their number; 0 if there was
  /// none since.
  std::uint32_t take_tokens(std::vector<ast::Token>& tokens);

 private:
  [[nodiscard]] std::optional<std::int64_t> distance(std::uint32_t begin, std::uint32_t end) const;
  const ast::Line* line_at(std::uint32_t begin);
  const ast::Line* same_line(const ast::Line& written);
  ast::Declaration* declaration_before(std::uint32_t end);
  template <class Node>
  std::optional<Node> given(Node* node, const LogicalLine& line, const ast::Line& earlier);

  const std::string_view earlier_text_;
  ast::File& earlier_;
  const std::string_view text_;
  const SourceId source_;
  std::size_t same_begin_ = 0;  ///< bytes that both texts begin with
  std::size_t same_end_ = 0;    ///< bytes that both end with, none of them among those
  std::size_t next_line_ = 0;   ///< where line_at() found its last one
  const ast::Line* given_ = nullptr;
  Shift shift_;  ///< of given_
};

}  // namespace robdef::syntax
