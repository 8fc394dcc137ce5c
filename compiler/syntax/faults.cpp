// SPDX-License-Identifier: Apache-2.0
// Puts what the parser met into the words of the language: which part of a statement is broken, and
// the statements that are made of names and numbers.
#include "compiler/syntax/explanation.hpp"

namespace robdef::syntax {

void Explanation::report() {
  if (!is_in(Parser::RuleEnumLine) && explain_comment()) return;
  if (explain_backslash()) return;
  switch (rule()) {
    case Parser::RuleEnumHeader:
    case Parser::RuleRecordHeader:
    case Parser::RuleObjectHeader:
      return names_line(Code::R0118, fmt::format("{} name", keyword()));
    case Parser::RuleUsingLine:
      return using_line();
    case Parser::RuleStdverLine:
      return version(Code::R0112);
    case Parser::RuleOptionLine:
      if (!follows(Parser::OPTION)) return version(Code::R0115);
      break;
    case Parser::RuleEndLine:
      return end_line();
    case Parser::RuleEnumLine:
    case Parser::RuleEnumValue:
    case Parser::RuleEnumNumber:
      return enum_line();
    case Parser::RuleType:
      return type();
    case Parser::RuleArray:
      return array();
    case Parser::RuleContainer:
      return container();
    case Parser::RuleParameters:
      return parameters();
    case Parser::RuleParameter:
      return missing_name();
    case Parser::RuleModifiers:
    case Parser::RuleModifier:
    case Parser::RuleArguments:
    case Parser::RuleArgument:
      return modifiers();
    case Parser::RuleFieldLine:
    case Parser::RuleMemberLine:
      return follows_type() ? missing_name() : after_member();
    case Parser::RuleEventName:
      return not_a_word(Code::R0124, "name");
    default:
      break;
  }
  if (is_in(Parser::RuleConstantParts) || is_in(Parser::RuleConstantLine)) return constant();
  if (is_in(Parser::RuleServiceLine)) return names_line(Code::R0109, "service name");
  if (is_in(Parser::RuleImportLine)) return names_line(Code::R0502, "service name");
  if (is_in(Parser::RuleExceptionLine)) return names_line(Code::R0117, "exception name");
  if (is_in(Parser::RuleImplementsLine)) return names_line(Code::R0122, "object name");
  unexpected(Code::R0107, "here");
}

// One name, plain or dotted, and nothing else.
void Explanation::names_line(Code code, std::string_view noun) {
  if (follows(fault_.keyword) && fault_.previous.begin == 0) {
    not_a_word(code, noun);
    return;
  }
  if (is(Parser::UNEXPECTED) && text() == "," && code == Code::R0122) {
    add(code, "one object only in an implements line")
        .label("a second name is not read")
        .help("write a line `implements` for each object");
    return;
  }
  unexpected(code, fmt::format("after the {}", noun));
}

void Explanation::using_line() {
  constexpr Code code = Code::R0504;
  if (is(Parser::NAME) && follows(Parser::USING)) {
    add(code, fmt::format("{} is not a qualified name", in_ticks(text())))
        .label("the service is missing")
        .help(fmt::format("write `using some.service.{}`", text().substr(0, longest_quote)));
  } else if (is(Parser::SPACED_AS)) {
    add(code, "more than one blank after `as`").label("exactly one blank follows `as`");
  } else if (follows(Parser::USING)) {
    not_a_word(code, "qualified name");
  } else if (follows(Parser::AS)) {
    not_a_word(code, "alias");
  } else if (is(Parser::NAME) && text() == "as") {
    add(code, "an alias is missing after `as`").label("the alias follows it");
  } else {
    unexpected(code, "in a using line");
  }
}

void Explanation::version(Code code) {
  if (follows(Parser::VERSION)) {
    unexpected(code, "after the version");
    return;
  }
  Diagnostic& diagnostic = is(Parser::NL)
                               ? add(code, "a version is missing")
                               : add(code, fmt::format("{} is not a version", in_ticks(text())));
  diagnostic.label("two to four numbers joined by dots belong here")
      .help(code == Code::R0112 ? "write `stdver 0.10`" : "write `option version 0.8`");
}

void Explanation::end_line() {
  add(Code::R0120, fmt::format("unexpected {} after `end`", in_ticks(text())))
      .label("`end` stands alone on its line");
}

void Explanation::enum_line() {
  constexpr Code code = Code::R0132;
  if (is(Parser::UNEXPECTED) && text() == "#") {
    add(code, "a comment behind a value")
        .label("not a comment here")
        .help("write the comment on a line of its own");
  } else if ((is(Parser::NL) || is(Parser::COMMA)) && follows(Parser::EQUALS)) {
    add(code, "a number is missing after `=`").label("the number belongs here");
  } else if (follows(Parser::EQUALS)) {
    add(code, fmt::format("{} is not a whole number", in_ticks(text())))
        .label("a decimal or hexadecimal whole number belongs here");
  } else if (follows(Parser::COMMA) && fault_.before_previous.type == Parser::COMMA) {
    add_at(code, fault_.previous, "two commas between enum values").label("one too many");
  } else if (is(Parser::ENUM_WORD)) {
    add(code, fmt::format("a comma is missing before {}", in_ticks(text())))
        .label("values are joined by commas");
  } else if (is(Parser::OTHER_WORD) && (follows(Parser::COMMA) || fault_.token.begin == 0)) {
    not_a_word(code, "value name");
  } else {
    unexpected(code, "in an enum").help("a value is `name` or `name = number`");
  }
}

Diagnostic& Explanation::add(Code code, std::string message) {
  return add_at(code, fault_.token, std::move(message));
}

Diagnostic& Explanation::add_at(Code code, FaultToken place, std::string message) {
  const std::size_t size = line_.text().size();
  std::size_t begin = std::min(place.begin, size);
  std::size_t end = std::min(place.end, size);
  // Blanks that are part of a token are not what is wrong, unless they are all of it.
  while (begin + 1 < end && is_blank(line_.text()[begin])) ++begin;
  while (begin + 1 < end && is_blank(line_.text()[end - 1])) --end;
  Span span = line_.span(begin, end);
  if (begin >= size) {
    // Something is missing at the end: point behind the last character.
    span = line_.span(size - 1, size);
    span.begin = span.end;
  }
  Diagnostic& diagnostic = report_.add(code, span, std::move(message));
  help_with_habits(diagnostic);
  return diagnostic;
}

// Signs that other languages have.
void Explanation::help_with_habits(Diagnostic& diagnostic) const {
  const std::string_view sign = text();
  if (sign == ";") {
    diagnostic.help("remove it: the end of the line ends a statement");
  } else if (sign == "{" && fault_.keyword >= Parser::ENUM && fault_.keyword <= Parser::OBJECT) {
    diagnostic.help("remove it: a block has no braces, and ends with a line `end`");
  }
}

Diagnostic& Explanation::unexpected(Code code, std::string_view where) {
  if (is(Parser::NL))
    return add(code, fmt::format("the line ends too early")).label("more belongs here");
  return add(code, fmt::format("unexpected {} {}", in_ticks(text()), where))
      .label("not expected here");
}

// A name was wanted and something like one, or nothing, stands there.
void Explanation::not_a_word(Code code, std::string_view noun) {
  if (is(Parser::NL)) {
    add(code, fmt::format("{} {} is missing", article_for(noun), noun)).label("belongs here");
    return;
  }
  const std::string_view word = text();
  Diagnostic& diagnostic =
      add(code, fmt::format("{} is not {} {}", in_ticks(word), article_for(noun), noun));
  const bool may_be_dotted = code != Code::R0118 && code != Code::R0302;
  if (word.find('.') != std::string_view::npos && !may_be_dotted) {
    diagnostic.label("this name has no dots");
  } else if (word.ends_with('.') || word.starts_with('.') ||
             word.find("..") != std::string_view::npos) {
    diagnostic.label("a segment is missing beside a dot");
  } else if (!is_letter(word.front())) {
    diagnostic.label("a name begins with a letter");
  } else if (word.ends_with('_') || word.find("_.") != std::string_view::npos) {
    diagnostic.label("a name does not end in an underscore");
  } else if (is(Parser::OTHER_WORD)) {
    diagnostic.label("each segment begins with a letter");
  } else {
    diagnostic.label("not expected here");
  }
}

bool Explanation::explain_comment() {
  if (!is(Parser::UNEXPECTED)) return false;
  const char next = character_at(fault_.token.end);
  const bool is_other_sign = text() == "/" && (next == '/' || next == '*');
  if (text() != "#" && !is_other_sign) return false;
  Diagnostic& diagnostic =
      add(Code::R0105, "a comment behind a statement").label("not a comment here");
  diagnostic.help(is_other_sign ? "a comment begins with `#`, on a line of its own, above"
                                : "write the comment on a line of its own, above");
  return true;
}

bool Explanation::explain_backslash() {
  if (is(Parser::UNEXPECTED) && text() == "\\") {
    add(Code::R0106, "a backslash inside a line")
        .label("joins lines only as the very last character of a line");
    return true;
  }
  // `dou\` and `ble a` on the next line: one word too many, and the last but one begins a line.
  const std::size_t joint = fault_.previous.begin;
  const bool is_line = rule() == Parser::RuleMemberLine || rule() == Parser::RuleFieldLine;
  if (!is_line || !is_word() || !follows(Parser::SPACED_WORD) || !line_.is_joint(joint) ||
      !is_word_character(character_at(joint - 1)) || !is_word_character(character_at(joint + 1))) {
    return false;
  }
  add_at(Code::R0106, {Parser::UNEXPECTED, joint, joint + 1}, "a continuation splits a word")
      .label("the backslash becomes a blank")
      .help("break the line between two words");
  return true;
}

std::string_view Explanation::text(FaultToken token) const {
  std::string_view text = line_.text();
  text = text.substr(std::min(token.begin, text.size()), token.end - token.begin);
  while (text.size() > 1 && is_blank(text.front())) text.remove_prefix(1);
  while (text.size() > 1 && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view Explanation::keyword() const {
  const auto end = std::find_if_not(line_.text().begin(), line_.text().end(), is_word_character);
  return line_.text().substr(0, static_cast<std::size_t>(end - line_.text().begin()));
}

std::string Explanation::in_ticks(std::string_view text) {
  if (text.size() > longest_quote) return fmt::format("`{}...`", text.substr(0, longest_quote));
  return fmt::format("`{}`", text);
}

void report_fault(const Fault& fault, const LogicalLine& line, Report& report) {
  Explanation(fault, line, report).report();
}

}  // namespace robdef::syntax
