// SPDX-License-Identifier: Apache-2.0
#include "compiler/diagnostics/mutations.hpp"

#include <algorithm>
#include <array>
#include <random>
#include <string_view>
#include <vector>

namespace robdef {
namespace {

class Mutation {
 public:
  Mutation(std::string text, std::uint64_t seed) : text_(std::move(text)), random_(seed) {}

  std::string run() && {
    for (std::size_t left = 1 + below(8); left > 0; --left) change();
    return std::move(text_);
  }

 private:
  std::size_t below(std::size_t limit) { return limit == 0 ? 0 : random_() % limit; }

  template <std::size_t size>
  std::string one_of(const std::array<std::string_view, size>& choices) {
    return std::string(choices[below(size)]);
  }

  // Where a line begins, and where its text ends.
  std::size_t line_begin() {
    const std::size_t before = text_.rfind('\n', below(text_.size()));
    return before == std::string::npos ? 0 : before + 1;
  }
  [[nodiscard]] std::size_t line_end(std::size_t begin) const {
    return std::min(text_.find('\n', begin), text_.size());
  }

  // Somewhere behind one of these characters; the end if there is none.
  std::size_t behind_any(std::string_view characters) {
    const std::size_t found = text_.find_first_of(characters, below(text_.size()));
    return found == std::string::npos ? text_.size() : found + 1;
  }

  void change() {
    switch (below(16)) {
      case 0:
        return insert_one(line_begin(), blank_lines);
      case 1:
        return indent();
      case 2:
        return insert_one(behind_any(" "), blanks);
      case 3:
        return insert_one(behind_any(",()[]{}=:"), blanks);
      case 4:
        return continue_line();
      case 5:
        return insert_one(line_begin(), comments);
      case 6:
        return insert_one(line_end(line_begin()), blanks);
      case 7:
        return insert(line_end(line_begin()), "\r");
      case 8:
        return remove_last_line_end();
      case 9:
        return replace_byte();
      case 10:
        return remove_line();
      case 11:
        return repeat_line();
      case 12:
        return erase_some(below(text_.size()), 12);
      case 13:
        return remove_blank_line();
      case 14:
        return use_carriage_returns();
      default:
        return insert_one(below(text_.size() + 1), scraps);
    }
  }

  // The place is chosen first: compilers evaluate arguments in different orders, and a seed is to
  // give the same text everywhere.
  template <std::size_t size>
  void insert_one(std::size_t at, const std::array<std::string_view, size>& choices) {
    insert(at, one_of(choices));
  }
  void erase_some(std::size_t at, std::size_t most) { erase(at, 1 + below(most)); }

  void insert(std::size_t at, const std::string& what) {
    text_.insert(std::min(at, text_.size()), what);
  }
  void erase(std::size_t at, std::size_t count) {
    if (at < text_.size()) text_.erase(at, count);
  }

  void indent() {
    const std::size_t begin = line_begin();
    const std::size_t content = text_.find_first_not_of(" \t", begin);
    if (content != std::string::npos) text_.replace(begin, content - begin, one_of(blanks));
  }

  void continue_line() {
    const std::size_t at = behind_any(" ");
    const std::size_t count = below(2);
    if (at < text_.size()) text_.replace(at - 1, count, one_of(continuations));
  }

  void remove_last_line_end() {
    while (!text_.empty() && text_.back() == '\n') text_.pop_back();
  }

  void replace_byte() {
    constexpr std::string_view bytes = " \t\\\n\r#,[](){}=:.x0_\"\xC3";
    if (!text_.empty()) text_[below(text_.size())] = bytes[below(bytes.size())];
  }

  void remove_line() {
    const std::size_t begin = line_begin();
    erase(begin, line_end(begin) + 1 - begin);
  }

  void repeat_line() {
    const std::size_t begin = line_begin();
    insert(line_begin(), text_.substr(begin, line_end(begin) + 1 - begin));
  }

  void remove_blank_line() {
    const std::size_t found = text_.find("\n\n", below(text_.size()));
    if (found != std::string::npos) erase(found, 1);
  }

  void use_carriage_returns() {
    std::string result;
    for (const char c : text_) result += c == '\n' ? std::string("\r\n") : std::string(1, c);
    text_ = std::move(result);
  }

  static constexpr std::array<std::string_view, 4> blank_lines = {"\n", "  \n", "\t\n\n", "\r\n"};
  static constexpr std::array<std::string_view, 6> blanks = {"",   " ",       "  ",
                                                             "\t", "       ", " \t "};
  static constexpr std::array<std::string_view, 4> continuations = {"\\\n", " \\\n  ", "\\\r\n\t",
                                                                    " \\\n \\\n "};
  static constexpr std::array<std::string_view, 8> comments = {
      "# one\n",    "  ## two\n",  "#\n",          "## a \\\n",
      "\t# b \\\n", "##c\r\n\r\n", "# \xC3\xA4\n", "    ## d\n\n## e\n"};
  static constexpr std::array<std::string_view, 10> scraps = {"end\n",
                                                              "struct X\n",
                                                              "object Y\n",
                                                              "\f",
                                                              std::string_view("\0", 1),
                                                              " [readonly , nolock]",
                                                              "##",
                                                              "\\",
                                                              "\n\n\n",
                                                              "enum Z\na=1,b\n"};

  std::string text_;
  std::mt19937_64 random_;
};

}  // namespace

std::string mutated(std::string text, std::uint64_t seed) {
  return Mutation(std::move(text), seed).run();
}

}  // namespace robdef
