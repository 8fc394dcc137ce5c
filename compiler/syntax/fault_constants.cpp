// SPDX-License-Identifier: Apache-2.0
// What can be wrong with constants and their values.
#include "compiler/syntax/explanation.hpp"
#include "compiler/syntax/literals.hpp"

namespace robdef::syntax {

void Explanation::constant() {
  if (is_in(Parser::RuleConstantValue)) {
    constant_value();
  } else if (is_in(Parser::RuleConstantType)) {
    not_a_word(Code::R0301, "type");
  } else if (rule() == Parser::RuleConstantLine || rule() == Parser::RuleOptionLine) {
    unexpected(Code::R0302, "after the value");
  } else if (is(Parser::NL)) {
    add(Code::R0302, "a name and a value are missing").label("they belong here");
  } else if (is(Parser::OTHER_WORD) && text().ends_with('"')) {
    add_at(Code::R0302, {Parser::UNEXPECTED, fault_.token.end - 1, fault_.token.end},
           "a blank is missing before the value")
        .label("a blank belongs here");
  } else {
    not_a_word(Code::R0302, "constant name");
  }
}

void Explanation::constant_value() {
  constexpr Code code = Code::R0302;
  const bool is_start = rule() == Parser::RuleConstantValue && follows(Parser::NAME) &&
                        fault_.rule_begin == fault_.token.begin;
  if (is_start && is(Parser::NL)) {
    add(code, "a value is missing").label("the value belongs here");
  } else if (is(Parser::NL)) {
    add(code, "the `}` of the value is missing").label("`}` belongs here");
  } else if (is(Parser::UNEXPECTED) && text() == "\"") {
    text_constant();
  } else if (follows(Parser::COMMA) && is(Parser::CLOSE_VALUE)) {
    add_at(code, fault_.previous, "a comma behind the last element").label("one too many");
  } else if (follows(Parser::COLON) && is(Parser::CLOSE_VALUE)) {
    add(code, "the name of a constant is missing after `:`").label("the name belongs here");
  } else if (rule() == Parser::RuleConstantField && follows(Parser::COLON)) {
    add(code, fmt::format("{} is not the name of a constant", in_ticks(text())))
        .label("a struct constant is made of other constants, by their names");
  } else if (is(Parser::OTHER_WORD) && is_digit(text().front())) {
    Diagnostic& diagnostic = add(code, fmt::format("{} is not a number", in_ticks(text())));
    const bool is_octal = text().find_first_not_of("0123456789") == std::string_view::npos;
    if (is_octal) diagnostic.label("a number has no leading zeros");
    if (text().starts_with("0X")) diagnostic.help("write `0x` in lower case");
  } else if (is(Parser::OPEN_CONTAINER)) {
    add(code, "a blank is missing before the value").label("a blank belongs here");
  } else if (is_start) {
    add(code, fmt::format("{} is not a value", in_ticks(text())))
        .label("a number, a string or `{...}` belongs here");
  } else {
    unexpected(code, "in a value");
  }
}

// The lexer has no string from here on: it is not closed, or an escape is not one.
void Explanation::text_constant() {
  const StringFault fault = find_string_fault(line_.text().substr(fault_.token.begin));
  const std::size_t begin = fault_.token.begin + fault.begin;
  const FaultToken place{Parser::UNEXPECTED, begin, fault_.token.begin + fault.end};
  if (fault.is_unclosed) {
    add(Code::R0302, "a string without its closing quote").label("begins here");
  } else {
    add_at(Code::R0302, place, fmt::format("unknown escape {} in a string", in_ticks(text(place))))
        .label("not an escape")
        .help(R"(the escapes are \" \\ \/ \b \f \n \r \t and \u with four hexadecimal digits)");
  }
}

}  // namespace robdef::syntax
