// SPDX-License-Identifier: Apache-2.0
// Lines that are not statements, or not where they stand. Reports P01, P19, L5, L6.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "compiler/diagnostics/spelling.hpp"
#include "compiler/syntax/file_parser.hpp"

namespace robdef::syntax {
namespace {

struct Habit {
  std::string_view word;
  std::string_view help;
};

// What other languages call it.
constexpr std::array habits = {
    Habit{"message", "a type with fields is a `struct`"},
    Habit{"record", "a type with fields is a `struct`"},
    Habit{"class", "a type with members is an `object`, one with fields a `struct`"},
    Habit{"interface", "a type with members is an `object`"},
    Habit{"module", "the first line names the definition: `service some.name`"},
    Habit{"namespace", "the first line names the definition: `service some.name`"},
    Habit{"package", "the first line names the definition: `service some.name`"},
    Habit{"syntax", "the version of the language is a line such as `stdver 0.10`"},
    Habit{"include", "other definitions are read by `import some.name`"},
    Habit{"typedef", "a name of another definition gets a short one by `using`"},
    Habit{"const", "write `constant`"},
    Habit{"rpc", "write `function`"},
    Habit{"method", "write `function`"},
    Habit{"def", "write `function`"},
    Habit{"attribute", "write `property`"},
    Habit{"signal", "write `event`"},
};

constexpr std::array<std::string_view, 8> types_elsewhere = {
    "int", "float", "char", "long", "short", "unsigned", "boolean", "repeated"};

std::string_view help_with_word(std::string_view word) {
  const auto found = std::find_if(habits.begin(), habits.end(),
                                  [word](const Habit& habit) { return habit.word == word; });
  if (found != habits.end()) return found->help;
  const bool is_type =
      is_built_in_type(word) ||
      std::find(types_elsewhere.begin(), types_elsewhere.end(), word) != types_elsewhere.end();
  return is_type ? "a line begins with its keyword: `field double x`, `property double x`" : "";
}

std::string_view help_with_sign(std::string_view line) {
  if (line.starts_with("//") || line.starts_with("/*")) return "a comment begins with `#`";
  if (line.starts_with('}')) return "a block ends with a line `end`";
  if (line.starts_with('{')) return "remove it: a block has no braces, and ends with a line `end`";
  if (line.starts_with(';')) return "remove it: the end of the line ends a statement";
  return "";
}

}  // namespace

// A keyword is followed by a blank and a word.
bool FileParser::has_operand(Keyword keyword) {
  const std::string_view text = line_.text();
  const std::size_t end = first_word().size();
  const std::size_t operand = std::min(text.find_first_not_of(" \t", end), text.size());
  if (operand > end && operand < text.size() && is_word_character(text[operand])) return true;
  if (operand >= text.size()) {
    report()
        .add(Code::R0107, first_word_span(), fmt::format("nothing follows `{}`", text_of(keyword)))
        .label("the line ends here");
  } else if (text[operand] == '#') {
    report()
        .add(Code::R0105, line_.span(operand, operand + 1), "a comment behind a statement")
        .label("not a comment here")
        .help("write the comment on a line of its own, above");
  } else {
    report()
        .add(Code::R0107, line_.span(operand, operand + 1),
             fmt::format("unexpected `{}` after `{}`", text[operand], text_of(keyword)))
        .label("a word belongs here");
  }
  return false;
}

// A backslash with a blank behind it is the end of a line that was meant to be continued.
bool FileParser::cut_badly() {
  if (!line_.text().ends_with('\\') || first_word() == text_of(Keyword::option)) return false;
  const std::size_t size = line_.text().size();
  report()
      .add(Code::R0106, line_.span(size - 1, size),
           "a blank behind the backslash of a continuation")
      .label("does not join the next line")
      .help("remove the blank behind it");
  block_.has_content = true;
  block_.is_whole = false;
  wants_service_ = false;
  reader_.skip_physical_line();
  return true;
}

void FileParser::unknown_statement() {
  wants_service_ = false;
  if (explain_split_keyword()) return;
  const std::string_view word = first_word();
  if (word.empty()) {
    Diagnostic& diagnostic =
        report().add(Code::R0107, line_.span(0, 1),
                     fmt::format("a line that begins with `{}`", line_.text().front()));
    diagnostic.label("a keyword belongs here");
    const std::string_view help = help_with_sign(line_.text());
    if (!help.empty()) diagnostic.help(std::string(help));
    return;
  }
  Diagnostic& diagnostic = report().add(Code::R0107, line_.span(0, word.size()),
                                        fmt::format("unknown statement `{}`", word.substr(0, 60)));
  diagnostic.label("not a keyword");
  if (!report().may_suggest(1)) return;
  std::string lower(word);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  const std::string_view near = nearest(word, keyword_texts());
  const std::string_view habit = help_with_word(word);
  if (!habit.empty()) {
    diagnostic.help(std::string(habit));
  } else if (keyword_of(lower) != Keyword::none) {
    diagnostic.help(fmt::format("keywords are written in lower case: `{}`", lower))
        .edit(first_word_span(), lower);
  } else if (!near.empty()) {
    diagnostic.help(fmt::format("`{}` is close", near)).edit(first_word_span(), std::string(near));
  }
}

// `prop\` and `erty double a` on the next line.
bool FileParser::explain_split_keyword() {
  const std::string_view text = line_.text();
  const std::size_t joint = first_word().size();
  if (joint == 0 || joint >= text.size() || !line_.is_joint(joint)) return false;
  std::string_view rest = text.substr(joint + 1);
  const auto end = std::find_if_not(rest.begin(), rest.end(), is_word_character);
  rest = rest.substr(0, static_cast<std::size_t>(end - rest.begin()));
  const std::string whole = std::string(first_word()) + std::string(rest);
  if (keyword_of(whole) == Keyword::none) return false;
  report()
      .add(Code::R0106, line_.span(joint, joint + 1),
           fmt::format("a continuation splits the word `{}`", whole))
      .label("the backslash becomes a blank")
      .help("break the line between two words");
  return true;
}

// A field in an object, a member in a struct.
void FileParser::misplaced(Keyword keyword) {
  Diagnostic& diagnostic =
      report()
          .add(Code::R0121, first_word_span(),
               fmt::format("`{}` inside {}", text_of(keyword), with_article(block_.keyword)))
          .also(block_.header, fmt::format("the {}", text_of(block_.keyword)));
  if (keyword == Keyword::field) {
    diagnostic.label("an object has members, not fields")
        .help("write `property`")
        .edit(first_word_span(), "property");
  } else if (keyword == Keyword::property) {
    diagnostic.label(fmt::format("a {} has fields", text_of(block_.keyword)))
        .help("write `field`")
        .edit(first_word_span(), "field");
  } else {
    diagnostic.label("belongs into an object");
  }
}

// A statement that stands outside of blocks only: the block was not closed, or the line is astray.
void FileParser::outside_only(Keyword keyword) {
  if (!is_block_keyword(keyword)) {
    report()
        .add(Code::R0107, first_word_span(),
             fmt::format("`{}` inside {}", text_of(keyword), with_article(block_.keyword)))
        .label("stands outside of blocks only")
        .also(block_.header, fmt::format("the {}", text_of(block_.keyword)));
    return;
  }
  leave_block_open(first_word_span());
  read_outside(keyword);
  expects_strays_ = true;
}

// A line of a block where no block is.
void FileParser::stray(Keyword keyword) {
  // The rest of a block that was taken for closed.
  if (expects_strays_) return;
  if (keyword == Keyword::end) {
    report().add(Code::R0107, first_word_span(), "`end` without a block").label("closes nothing");
    return;
  }
  report()
      .add(Code::R0107, first_word_span(), fmt::format("`{}` outside of a block", text_of(keyword)))
      .label(keyword == Keyword::field ? "belongs into a struct, pod or namedarray"
                                       : "belongs into an object");
}

}  // namespace robdef::syntax
