// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "compiler/diagnostics/report.hpp"
#include "compiler/syntax/ast.hpp"
#include "compiler/syntax/lines.hpp"

namespace robdef::syntax {

/// `stdver 0.10`
struct VersionLine {
  ast::Version version;
  Span span;  ///< the number
};

/// What an `option` line holds: a version, a constant, or text without a meaning.
using OptionLine = std::variant<VersionLine, ast::Constant, std::monostate>;

/// `end` or, in old files, `end struct`.
struct EndLine {
  std::optional<ast::Name> kind;
};

/// The values that stand on one line of an enum.
struct EnumLine {
  std::vector<ast::EnumValue> values;
  bool ends_in_comma = false;
};

/// Reads single statements by the rules of the grammar. Each function wants a line that begins with
/// its keyword and an operand; what does not fit the grammar is reported as one finding, in the
/// words of the language, and gives nothing.
class LineParser {
 public:
  LineParser();
  ~LineParser();
  LineParser(const LineParser&) = delete;
  LineParser& operator=(const LineParser&) = delete;

  std::optional<ast::Name> service(const LogicalLine& line, Report& report);
  std::optional<VersionLine> stdver(const LogicalLine& line, Report& report);
  std::optional<OptionLine> option(const LogicalLine& line, Report& report);
  std::optional<ast::Import> import(const LogicalLine& line, Report& report);
  std::optional<ast::Using> using_line(const LogicalLine& line, Report& report);
  std::optional<ast::Exception> exception(const LogicalLine& line, Report& report);
  std::optional<ast::Constant> constant(const LogicalLine& line, Report& report);
  /// The name of a block: enum, struct, pod, namedarray, object.
  std::optional<ast::Name> header(const LogicalLine& line, Report& report);
  std::optional<EndLine> end(const LogicalLine& line, Report& report);
  std::optional<EnumLine> enum_line(const LogicalLine& line, Report& report);
  std::optional<ast::Implements> implements(const LogicalLine& line, Report& report);
  std::optional<ast::Field> field(const LogicalLine& line, Report& report);
  std::optional<ast::Member> member(const LogicalLine& line, Report& report);

  /// Adds the tokens of the line that was read since the last call, and returns how many. 0 if
  /// there was none, or if it does not fit the grammar.
  std::uint32_t take_tokens(const LogicalLine& line, std::vector<ast::Token>& tokens);

 private:
  struct Machinery;
  std::unique_ptr<Machinery> machinery_;
};

}  // namespace robdef::syntax
