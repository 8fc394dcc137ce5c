// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <RobdefParser.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

#include "compiler/syntax/faults.hpp"
#include "compiler/syntax/words.hpp"

namespace robdef::syntax {

/// Finds the words for one fault. The rule that was being read says which part of a statement is
/// broken, and so the code; the token that did not fit says how.
class Explanation {
 public:
  Explanation(const Fault& fault, const LogicalLine& line, Report& report)
      : fault_(fault), line_(line), report_(report) {}

  void report();

 private:
  using Parser = grammar::RobdefParser;

  // Messages stay readable when a line holds a word of a megabyte.
  static constexpr std::size_t longest_quote = 60;
  static std::string in_ticks(std::string_view text);

  // Families of rules.
  void names_line(Code code, std::string_view noun);
  void using_line();
  void version(Code code);
  void end_line();
  void enum_line();
  void missing_name();
  void type();
  void array();
  void container();
  void parameters();
  void event_with_type();
  void modifiers();
  void after_member();
  void constant();
  void constant_value();
  void text_constant();

  Diagnostic& add(Code code, std::string message);
  // A type that is wrong as a whole is the statement's fault.
  [[nodiscard]] Code form_code() const {
    return is_in(Parser::RuleConstantParts) ? Code::R0301 : Code::R0124;
  }
  Diagnostic& add_at(Code code, FaultToken place, std::string message);
  Diagnostic& unexpected(Code code, std::string_view where);
  void not_a_word(Code code, std::string_view noun);
  bool explain_comment();
  bool explain_backslash();
  bool explain_modifiers_in_parentheses();
  void help_with_habits(Diagnostic& diagnostic) const;
  bool explain_blank_in_type();

  [[nodiscard]] std::size_t rule() const { return fault_.rules.front(); }
  [[nodiscard]] bool is_in(std::size_t rule) const {
    return std::find(fault_.rules.begin(), fault_.rules.end(), rule) != fault_.rules.end();
  }
  [[nodiscard]] bool is(std::size_t type) const { return fault_.token.type == type; }
  [[nodiscard]] bool follows(std::size_t type) const { return fault_.previous.type == type; }
  [[nodiscard]] bool is_word() const;
  [[nodiscard]] std::string_view rest() const;
  [[nodiscard]] bool follows_type() const;
  [[nodiscard]] std::string_view text(FaultToken token) const;
  [[nodiscard]] std::string_view text() const { return text(fault_.token); }
  [[nodiscard]] std::string_view keyword() const;
  [[nodiscard]] std::string with_article() const {
    return fmt::format("{} {}", article_for(keyword()), keyword());
  }
  [[nodiscard]] char character_at(std::size_t offset) const {
    return offset < line_.text().size() ? line_.text()[offset] : '\n';
  }

  const Fault& fault_;
  const LogicalLine& line_;
  Report& report_;
};

}  // namespace robdef::syntax
