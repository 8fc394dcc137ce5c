// SPDX-License-Identifier: Apache-2.0
// What can be wrong with fields and members: their types, names, parameters and modifiers.
#include "compiler/syntax/explanation.hpp"

namespace robdef::syntax {

// A word was wanted: the name of a member, field or parameter.
void Explanation::missing_name() {
  if (explain_blank_in_type()) return;
  if (is_in(Parser::RuleParameter)) {
    if (is(Parser::COMMA) || is(Parser::CLOSE_PARAMETERS) || is(Parser::NL)) {
      add_at(Code::R0127, fault_.previous,
             fmt::format("a name is missing after the type {}", in_ticks(text(fault_.previous))))
          .label("a parameter has a type and a name");
    } else {
      unexpected(Code::R0127, "in a parameter list");
    }
    return;
  }
  const bool has_parameters =
      fault_.keyword == Parser::FUNCTION || fault_.keyword == Parser::CALLBACK;
  if (is(Parser::OPEN_PARAMETERS) && has_parameters) {
    add_at(Code::R0125, fault_.previous,
           fmt::format("a type is missing before {}", in_ticks(text(fault_.previous))))
        .label(fmt::format("a {} has a return type", keyword()))
        .help(fmt::format("write `{} void {}(...)` if it returns nothing", keyword(),
                          text(fault_.previous).substr(0, longest_quote)));
  } else if (is(Parser::OPEN_PARAMETERS)) {
    after_member();
  } else if (is(Parser::NL) || is(Parser::OPEN_MODIFIERS)) {
    add_at(Code::R0124, {Parser::NL, fault_.previous.end, fault_.previous.end},
           fmt::format("a name is missing after {}", in_ticks(text(fault_.previous))))
        .label(fmt::format("{} has a type and a name", with_article()));
  } else {
    unexpected(Code::R0124, "where a name belongs");
  }
}

// A type was wanted.
void Explanation::type() {
  if (is_in(Parser::RuleParameters)) {
    parameters();
    return;
  }
  if (is(Parser::MEMBER_OTHER_WORD)) {
    add(Code::R0124, fmt::format("{} is not a type", in_ticks(text())))
        .label("a type begins with a letter");
  } else {
    add(Code::R0124, fmt::format("expected a type after `{}`", keyword()))
        .label("the type belongs here");
  }
}

void Explanation::array() {
  const bool is_blank_here = is(Parser::UNEXPECTED) && is_blank(text().front());
  const bool is_open =
      is(Parser::NL) || (is_blank_here && is_letter(character_at(fault_.token.end)));
  if (is_open) {
    add(Code::R0128, "the `]` of an array is missing").label("`]` belongs here");
  } else if (is_blank_here) {
    add(form_code(), "a blank inside a type").label("types are written without blanks");
  } else if (is(Parser::GLUED_ARRAY)) {
    add(form_code(), "a blank is missing between the type and the name")
        .label("a blank belongs behind the `]`");
  } else if (follows(Parser::COMMA) || (is(Parser::COMMA) && follows(Parser::OPEN_ARRAY))) {
    add(Code::R0130, "an array dimension is missing").label("a number belongs here");
  } else if (is(Parser::MINUS)) {
    add(Code::R0128, "a sign in an array length")
        .label("lengths have no sign")
        .help("`[4-]` is an array of at most 4");
  } else {
    add(Code::R0128, fmt::format("unexpected {} in an array part", in_ticks(text())))
        .label("not part of an array")
        .help("the forms are `[]`, `[4]`, `[4-]`, `[*]`, `[4,]`, `[3,3]`");
  }
}

void Explanation::container() {
  constexpr std::string_view forms = "there are `{list}`, `{int32}`, `{string}` and `{generator}`";
  const bool is_blank_here = is(Parser::UNEXPECTED) && is_blank(text().front());
  const bool is_open = is(Parser::NL) || (is_blank_here && follows(Parser::CONTAINER_KIND));
  if (is_open) {
    add(Code::R0128, "the `}` of a container is missing").label("`}` belongs here");
  } else if (is_blank_here) {
    add(form_code(), "a blank inside a type").label("types are written without blanks");
  } else if (is(Parser::GLUED_CONTAINER)) {
    add(form_code(), "a blank is missing between the type and the name")
        .label("a blank belongs behind the `}`");
  } else if (is(Parser::OTHER_WORD)) {
    add(Code::R0129, fmt::format("unknown container {}", in_ticks(text())))
        .label("there is no such container")
        .help(std::string(forms));
  } else if (is(Parser::CLOSE_CONTAINER)) {
    add(Code::R0129, "an empty container").label("its kind belongs here").help(std::string(forms));
  } else {
    add(Code::R0128, fmt::format("unexpected {} in a container", in_ticks(text())))
        .label("not part of a container")
        .help(std::string(forms));
  }
}

void Explanation::parameters() {
  constexpr Code code = Code::R0127;
  const bool is_opening = rule() == Parser::RuleParameters && !is_in(Parser::RuleParameter) &&
                          fault_.rule_begin == fault_.token.begin;
  if (is_opening && fault_.keyword == Parser::EVENT && is_word()) {
    event_with_type();
  } else if (is_opening && (is(Parser::NL) || is(Parser::OPEN_MODIFIERS))) {
    add_at(Code::R0125, {Parser::NL, fault_.previous.end, fault_.previous.end},
           fmt::format("the parentheses of {} are missing", with_article()))
        .label("`()` belongs here");
  } else if (is_opening) {
    after_member();
  } else if (follows(Parser::COMMA) && is(Parser::CLOSE_PARAMETERS)) {
    add_at(code, fault_.previous, "a comma behind the last parameter").label("one too many");
  } else if (is(Parser::NL)) {
    add(code, "the closing parenthesis is missing").label("`)` belongs here");
  } else if (is(Parser::OPEN_ARRAY)) {
    add(code, "an array part behind a parameter name")
        .label("belongs to the type")
        .help("write for instance `double[] a`");
  } else if (is_word() && fault_.previous.type != Parser::COMMA &&
             !follows(Parser::OPEN_PARAMETERS)) {
    add(code, fmt::format("a comma is missing before {}", in_ticks(text())))
        .label("parameters are joined by commas");
  } else {
    unexpected(code, "in a parameter list");
  }
}

// `event void e()`, or `event e double a` without parentheses.
void Explanation::event_with_type() {
  const std::string_view first = text(fault_.previous);
  const bool has_type_second = !is_built_in_type(first) && is_word() && is_built_in_type(text());
  if (has_type_second) {
    const std::string_view parameters = rest();
    const bool is_short = parameters.size() <= longest_quote &&
                          parameters.find(' ') != parameters.npos &&
                          parameters.find_first_of("()") == parameters.npos &&
                          parameters.find(" [") == parameters.npos;
    add_at(Code::R0125, {Parser::NL, fault_.previous.end, fault_.previous.end},
           "the parentheses of an event are missing")
        .label("`(` belongs here")
        .help(fmt::format("write `event {}({})`", first.substr(0, longest_quote),
                          is_short ? parameters : "..."));
    return;
  }
  Diagnostic& diagnostic =
      add_at(Code::R0125, fault_.previous, "an event with a type").label("an event has no type");
  if (is_word() && rest().find('(') != std::string_view::npos)
    diagnostic.help(fmt::format("write `event {}(...)`", text().substr(0, longest_quote)));
}

// The rest of the line, from the token on.
std::string_view Explanation::rest() const {
  std::string_view text = line_.text();
  text.remove_prefix(std::min(fault_.token.begin, text.size()));
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  return text;
}

// `property double x (readonly)`
bool Explanation::explain_modifiers_in_parentheses() {
  std::string_view inside = rest();
  if (!inside.starts_with('(')) return false;
  inside = inside.substr(1, inside.find(')') - 1);
  const auto first_end = std::find_if_not(inside.begin(), inside.end(), is_word_character);
  const auto word = inside.substr(0, static_cast<std::size_t>(first_end - inside.begin()));
  if (word.empty() || nearest_modifier(word).empty()) return false;
  const bool is_short = inside.size() <= longest_quote;
  add(Code::R0126, "modifiers in parentheses")
      .label("modifiers stand in brackets")
      .help(fmt::format("write `[{}]`", is_short && word == nearest_modifier(word)
                                            ? inside
                                            : nearest_modifier(word)));
  return true;
}

void Explanation::modifiers() {
  constexpr Code code = Code::R0126;
  if (is(Parser::CLOSE_MODIFIERS) && follows(Parser::OPEN_MODIFIERS)) {
    add(code, "an empty modifier list").label("a modifier belongs here").help("remove `[]`");
  } else if (is(Parser::SPACED_MODIFIERS)) {
    add(code, "a blank before `]`").label("no blank may stand here");
  } else if (is(Parser::SPACED_ARGUMENTS)) {
    add(code, "a blank before the arguments of a modifier").label("no blank may stand here");
  } else if (is(Parser::SPACED_COMMA)) {
    add(code, "a blank before a comma").label("no blank may stand here");
  } else if (is(Parser::CLOSE_ARGUMENTS) && follows(Parser::OPEN_ARGUMENTS)) {
    add(code, "a modifier with empty parentheses").help("leave the parentheses out");
  } else if (is(Parser::UNEXPECTED) && text() == "\"") {
    add(code, "a string as the argument of a modifier")
        .label("an argument is a number or the name of a constant");
  } else if (is(Parser::NL)) {
    const bool is_argument = is_in(Parser::RuleArguments);
    add(code, fmt::format("the `{}` of the modifiers is missing", is_argument ? ')' : ']'))
        .label("belongs here");
  } else {
    unexpected(code, "in a modifier list");
  }
}

// Everything was read that a field or member of this kind can have, and more follows.
void Explanation::after_member() {
  if (follows(Parser::MEMBER_WORD) && (is(Parser::OPEN_ARRAY) || is(Parser::OPEN_CONTAINER))) {
    event_with_type();
  } else if (is(Parser::OPEN_PARAMETERS)) {
    if (explain_modifiers_in_parentheses()) return;
    add(Code::R0125, fmt::format("{} with parentheses", with_article()))
        .label(fmt::format("{} has no parameters", with_article()))
        .help("a `function` has parameters");
  } else if (follows(Parser::CLOSE_MODIFIERS)) {
    unexpected(Code::R0126, "after the modifiers");
  } else if (follows(Parser::CLOSE_CONTAINER) && is(Parser::OPEN_ARRAY)) {
    add(Code::R0128, "an array part behind the container")
        .label("the array part comes before the container");
  } else if (is(Parser::OPEN_ARRAY) && is_letter(character_at(fault_.token.end))) {
    add(Code::R0126, "a blank is missing before the modifiers").label("a blank belongs here");
  } else if (is(Parser::OPEN_ARRAY)) {
    add(Code::R0126, "an array part behind the name")
        .label("belongs to the type")
        .help("write for instance `double[3] a`, and modifiers behind a blank: `a [readonly]`");
  } else if (is(Parser::COMMA)) {
    add(Code::R0124, fmt::format("one name only for each {}", keyword()))
        .label(fmt::format("write a line `{}` for each", keyword()));
  } else {
    unexpected(Code::R0124, fmt::format("in {}", with_article()));
  }
}

bool Explanation::explain_blank_in_type() {
  const char inside = character_at(fault_.token.end);
  const bool is_array =
      is(Parser::OPEN_MODIFIERS) && (is_digit(inside) || inside == ']' || inside == '*');
  if (is_array || is(Parser::SPACED_CONTAINER)) {
    add(Code::R0124, "a blank inside a type").label("types are written without blanks");
  } else if (follows(Parser::CLOSE_CONTAINER) && is(Parser::OPEN_ARRAY)) {
    add(Code::R0128, "an array part behind a container")
        .label("the array part comes before the container");
  } else if (is(Parser::OPEN_CONTAINER)) {
    add(Code::R0128, "more than one container").label("a type has one container at most");
  } else if (is(Parser::OPEN_ARRAY)) {
    add(Code::R0128, "more than one array part").label("a type has one array part at most");
  } else {
    return false;
  }
  return true;
}

bool Explanation::is_word() const {
  switch (fault_.token.type) {
    case Parser::MEMBER_WORD:
    case Parser::MEMBER_QUALIFIED:
    case Parser::MEMBER_OTHER_WORD:
    case Parser::SPACED_WORD:
      return true;
    default:
      return false;
  }
}

bool Explanation::follows_type() const {
  switch (fault_.previous.type) {
    case Parser::MEMBER_WORD:
    case Parser::MEMBER_QUALIFIED:
    case Parser::CLOSE_ARRAY:
    case Parser::CLOSE_CONTAINER:
      return fault_.keyword != Parser::EVENT;
    default:
      return false;
  }
}

}  // namespace robdef::syntax
