// SPDX-License-Identifier: Apache-2.0
// Reads the rules of rr::Rights.
#include <array>
#include <charconv>
#include <fstream>
#include <functional>
#include <utility>

#include "rr/error.hpp"
#include "rr/rights.hpp"
#include "runtime/cpp/src/service/rights_line.hpp"

namespace rr {
namespace {

constexpr std::size_t largest_rights_file = 1024 * 1024;
constexpr std::string_view blanks = " \t\r";

/// A word and where it stands in its line, from 1.
struct Word {
  std::string_view text;
  std::size_t column = 1;
};

/// What is wrong at a column.
using Fail = std::function<void(std::size_t column, const std::string& what)>;

std::vector<Word> words_of(std::string_view line) {
  line = line.substr(0, line.find('#'));
  std::vector<Word> words;
  for (std::size_t at = line.find_first_not_of(blanks); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(blanks, at), line.size());
    words.push_back({line.substr(at, end - at), at + 1});
    at = line.find_first_not_of(blanks, end);
  }
  return words;
}

// The parts of a list, with commas between them.
std::vector<Word> parts_of(const Word& list, const Fail& fail) {
  std::vector<Word> parts;
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = std::min(list.text.find(',', begin), list.text.size());
    if (end == begin) fail(list.column + begin, "something is missing beside a comma");
    parts.push_back({list.text.substr(begin, end - begin), list.column + begin});
    if (end == list.text.size()) return parts;
    begin = end + 1;
  }
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_name(std::string_view text) {
  if (text.empty() || !is_letter(text.front())) return false;
  for (const char c : text) {
    if (!is_letter(c) && !is_digit(c) && c != '_') return false;
  }
  return true;
}

std::string decode_index(const Word& word, const Fail& fail) {
  std::string index;
  for (std::size_t i = 0; i < word.text.size(); ++i) {
    const char c = word.text[i];
    if (c != '%') {
      if (!is_letter(c) && !is_digit(c) && c != '_' && c != '-') {
        fail(word.column + i, "this byte of an index is written as `%` and two hexadecimal digits");
      }
      index += c;
      continue;
    }
    unsigned byte = 0;
    const char* const digits = word.text.data() + i + 1;
    const bool has_two = word.text.size() - i > 2;
    if (!has_two || std::from_chars(digits, digits + 2, byte, 16).ptr != digits + 2) {
      fail(word.column + i, "`%` is followed by two hexadecimal digits");
    }
    index += static_cast<char>(byte);
    i += 2;
  }
  if (index.empty()) fail(word.column, "an index is missing; `[*]` is any");
  return index;
}

PathPattern::Step read_step(const Word& word, const Fail& fail) {
  PathPattern::Step step;
  const std::size_t open = word.text.find('[');
  const std::string_view name = word.text.substr(0, open);
  if (name != "*" && !is_name(name)) {
    fail(word.column, "`" + std::string(name) + "` is no name of a path; `*` is any");
  }
  if (name != "*") step.name = name;
  if (open == std::string_view::npos) {
    step.is_any = name == "*";
    return step;
  }
  if (word.text.back() != ']') fail(word.column + open, "this bracket is not closed");
  const Word index{word.text.substr(open + 1, word.text.size() - open - 2), word.column + open + 1};
  if (index.text == "*") {
    step.is_any_index = true;
  } else {
    step.index = decode_index(index, fail);
  }
  return step;
}

PathPattern read_pattern(const Word& word, const Fail& fail) {
  PathPattern pattern;
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = std::min(word.text.find('.', begin), word.text.size());
    const Word part{word.text.substr(begin, end - begin), word.column + begin};
    const bool is_last = end == word.text.size();
    if (part.text == "**") {
      if (!is_last) fail(part.column, "`**` can only be the end of a path");
      pattern.is_below = true;
    } else {
      pattern.steps.push_back(read_step(part, fail));
    }
    if (is_last) return pattern;
    begin = end + 1;
  }
}

RightSet read_access(const Word& list, const Fail& fail) {
  RightSet access = 0;
  for (const Word& part : parts_of(list, fail)) {
    if (part.text == "*") {
      access = all_rights;
      continue;
    }
    RightSet found = 0;
    for (RightSet bit = 1; bit < all_rights; bit = static_cast<RightSet>(bit << 1U)) {
      if (right_name(static_cast<Right>(bit)) == part.text) found = bit;
    }
    if (found == 0) {
      fail(part.column, "`" + std::string(part.text) +
                            "` is no access: get, set, call, connect, send, peek, poke, read, "
                            "write, event, callback, lock, describe or `*`");
    }
    access = static_cast<RightSet>(access | found);
  }
  return access;
}

void read_who(const Word& word, Rights::Line& line, const Fail& fail) {
  const std::string_view text = word.text;
  if (text == "anyone") return;
  const bool is_user = text.starts_with("user:");
  if (!is_user && !text.starts_with("role:")) {
    fail(word.column,
         "`" + std::string(text) + "` is nobody: anyone, user:*, user:NAME or role:NAME");
  }
  line.name = text.substr(5);
  if (line.name.empty()) fail(word.column + 5, "a name is missing");
  line.who = is_user ? Rights::Line::Who::user : Rights::Line::Who::role;
  if (is_user && line.name == "*") line.who = Rights::Line::Who::any_user;
  if (!is_user && line.name == "*") fail(word.column + 5, "`user:*` is everybody who is logged in");
}

void read_members(const Word& list, Rights::Line& line, const Fail& fail) {
  for (const Word& part : parts_of(list, fail)) {
    if (part.text == "*") {
      line.members.clear();
      return;
    }
    if (!is_name(part.text)) fail(part.column, "`" + std::string(part.text) + "` is no member");
    line.members.emplace_back(part.text);
  }
}

Rights::Line read_line(const std::vector<Word>& words, const Fail& fail) {
  Rights::Line line;
  if (words[0].text != "allow" && words[0].text != "deny") {
    fail(words[0].column, "a rule begins with `allow` or `deny`");
  }
  line.is_allowed = words[0].text == "allow";
  if (words.size() < 2) fail(words[0].column, "the rule does not say who");
  read_who(words[1], line, fail);
  std::array<bool, 3> was_said{};
  for (std::size_t i = 2; i < words.size(); i += 2) {
    constexpr std::array<std::string_view, 3> kinds{"path", "member", "access"};
    std::size_t kind = 0;
    while (kind < kinds.size() && kinds[kind] != words[i].text) ++kind;
    if (kind == kinds.size()) {
      fail(words[i].column,
           "`" + std::string(words[i].text) + "` is none of path, member and access");
    }
    if (std::exchange(was_said[kind], true)) fail(words[i].column, "this has been said already");
    if (i + 1 == words.size()) fail(words[i].column, "something is missing behind this word");
    const Word& value = words[i + 1];
    if (kind == 0) {
      for (const Word& part : parts_of(value, fail)) {
        line.paths.push_back(read_pattern(part, fail));
      }
    } else if (kind == 1) {
      read_members(value, line, fail);
    } else {
      line.access = read_access(value, fail);
    }
  }
  if (line.paths.empty()) line.paths.push_back({{}, true});
  return line;
}

}  // namespace

Rights::Rights(std::string_view text, const std::string& source) {
  std::size_t number = 0;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    ++number;
    const std::vector<Word> words = words_of(line);
    if (words.empty()) continue;
    lines_.push_back(read_line(words, [&](std::size_t column, const std::string& what) {
      throw Error(ErrorCode::invalid_configuration, source + ":" + std::to_string(number) + ":" +
                                                        std::to_string(column) + ": " + what);
    }));
  }
}

Rights::Rights(const std::vector<Rule>& rules) {
  for (std::size_t i = 0; i < rules.size(); ++i) {
    const Rule& rule = rules[i];
    const auto fail = [&](std::size_t, const std::string& what) {
      throw Error(ErrorCode::invalid_configuration, "rule " + std::to_string(i + 1) + ": " + what);
    };
    const std::string_view first = rule.is_allowed ? "allow" : "deny";
    lines_.push_back(read_line({{first, 1},
                                {rule.who, 1},
                                {"path", 1},
                                {rule.path, 1},
                                {"member", 1},
                                {rule.member, 1},
                                {"access", 1},
                                {rule.access, 1}},
                               fail));
  }
}

std::shared_ptr<const Rights> Rights::from_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text(largest_rights_file + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  const auto size = static_cast<std::size_t>(file.gcount());
  if (!file.eof() || file.bad()) {
    const char* const what = size > largest_rights_file ? "` has more than 1 MiB" : "`";
    throw Error(ErrorCode::invalid_configuration, "cannot read `" + path + what);
  }
  return std::make_shared<const Rights>(std::string_view(text).substr(0, size), path);
}

}  // namespace rr
