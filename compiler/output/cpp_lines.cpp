// SPDX-License-Identifier: Apache-2.0
#include "compiler/output/cpp_lines.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "compiler/output/cpp_brackets.hpp"
#include "compiler/output/cpp_layout.hpp"

namespace robdef::cpp {
namespace {

/// A call whose only argument is a call, `return answer(f(a, b));`, as the list of the inner one.
std::optional<List> inner_list(const List& outer) {
  if (outer.items.size() != 1) return std::nullopt;
  std::optional<List> inner = list_of(outer.items.front());
  if (!inner || inner->after != ")" || inner->items.empty()) return std::nullopt;
  return inner;
}

/// `return {A, B[I]};`: items one below the other, and an index on a line of its own where it has
/// to.
std::string braces(std::string_view text, std::size_t indent) {
  constexpr std::string_view begin = "return {";
  constexpr std::string_view end = "};";
  if (!text.ends_with(end) || indent + text.size() <= line_width) return std::string(text);
  const std::size_t column = indent + begin.size();
  constexpr std::size_t deeper = 4;
  std::string result(begin);
  const auto items = items_of(text.substr(begin.size(), text.size() - begin.size() - end.size()));
  for (const std::string& item : items) {
    const bool is_last = &item == &items.back();
    const std::string ended = item + (is_last ? std::string(end) : ",\n" + blanks(column));
    const std::size_t index = item.find('[');
    if (column + item.size() + (is_last ? end.size() : 1) <= line_width || index == nowhere) {
      result += ended;
    } else {
      result.append(ended, 0, index).append("\n").append(blanks(column + deeper));
      result.append(ended, index);
    }
  }
  return result;
}

std::string call(std::string_view text, std::size_t indent) {
  const std::optional<List> outer = list_of(text);
  if (!outer) {
    if (text.starts_with("return {")) return braces(text, indent);
    const std::optional<List> braced = list_of(text, '{');
    return braced ? values(*braced, indent) : std::string(text);
  }
  const std::optional<List> inner = inner_list(*outer);
  if (!inner) return list(*outer, indent);
  std::string result = list({.before = outer->before + inner->before,
                             .items = inner->items,
                             .after = inner->after + outer->after},
                            indent);
  // When the inner one cannot be broken behind its parenthesis, the outer one is.
  const std::size_t end = result.find('\n');
  if (end == nowhere || result[end - 1] != '(') return result;
  constexpr std::size_t deeper = 4;
  return outer->before + "\n" + blanks(indent + deeper) +
         list(
             {.before = inner->before, .items = inner->items, .after = inner->after + outer->after},
             indent + deeper);
}

/// A type that is longer than a line: a list of types.
std::string type(std::string_view text, std::size_t indent) {
  if (indent + text.size() <= line_width || !text.ends_with('>')) return std::string(text);
  const std::size_t open = text.find('<');
  std::string_view inside = text.substr(open + 1, text.size() - open - 2);
  std::string before(text.substr(0, open + 1));
  std::string after = ">";
  const std::size_t parameters = find_outside(inside, '(');
  if (parameters != nowhere && inside.ends_with(')')) {
    before += inside.substr(0, parameters + 1);
    after = ")>";
    inside = inside.substr(parameters + 1, inside.size() - parameters - 2);
  }
  std::vector<std::string> items = items_of(inside);
  if (items.size() < 2 && parameters == nowhere && before.find("Event<") == nowhere) {
    return std::string(text);
  }
  return list({.before = std::move(before), .items = std::move(items), .after = std::move(after)},
              indent);
}

/// `virtual double get(int a) const`, to what is behind the parameters.
std::optional<Signature> signature_of(std::string_view text, std::size_t indent) {
  const std::optional<List> parts = list_of(text);
  if (!parts) return std::nullopt;
  std::string_view head = parts->before;
  head.remove_suffix(1);
  const std::size_t blank = find_last_outside(head, ' ');
  if (blank == nowhere) return std::nullopt;
  std::string_view result = head.substr(0, blank);
  if (result == "return") return std::nullopt;
  Signature signature{.name = std::string(head.substr(blank + 1)),
                      .parameters = parts->items,
                      .after = parts->after.substr(1)};
  constexpr std::string_view keyword = "virtual ";
  if (result.starts_with(keyword)) {
    signature.before = keyword;
    result.remove_prefix(keyword.size());
  }
  signature.result = type(result, indent);
  return signature;
}

/// A function with one statement.
std::optional<std::string> function(std::string_view text, std::size_t indent) {
  constexpr std::string_view end = " }";
  if (!text.ends_with(end)) return std::nullopt;
  const std::size_t body = find_last_outside(text.substr(0, text.size()), '{');
  if (body == nowhere || body + 2 > text.size() - end.size()) return std::nullopt;
  const auto signature = signature_of(text.substr(0, body - 1), indent);
  if (!signature) return std::nullopt;
  const std::string_view statement = text.substr(body + 2, text.size() - end.size() - body - 2);
  return opening(*signature, indent) + "\n" + blanks(indent + 2) + call(statement, indent + 2) +
         "\n" + blanks(indent) + "}";
}

/// A constructor that gives its parameters to its base: `explicit A(int a) : B(a) {}`.
std::optional<std::string> constructor(std::string_view text, std::size_t indent) {
  if (!text.ends_with(" {}")) return std::nullopt;
  constexpr std::string_view begin = " : ";
  const std::size_t colon = find_word(text, begin);
  if (colon == nowhere) return std::nullopt;
  const std::optional<Signature> signature = signature_of(text.substr(0, colon), indent);
  const std::optional<List> base = list_of(text.substr(colon + begin.size()));
  if (!signature || !base) return std::nullopt;
  constexpr std::size_t deeper = 4;
  return head(*signature, indent) + "\n" + blanks(indent + deeper) + ": " +
         list(*base, indent + deeper + 2);
}

/// `class A : public B, public C {`.
std::optional<std::string> class_begin(std::string_view text, std::size_t indent) {
  constexpr std::string_view begin = "class ";
  constexpr std::string_view colon = " : ";
  constexpr std::string_view end = " {";
  const std::size_t bases = find_word(text, colon);
  if (!text.starts_with(begin) || !text.ends_with(end) || bases == nowhere) return std::nullopt;
  const std::size_t first = bases + colon.size();
  return class_head(text.substr(begin.size(), bases - begin.size()),
                    items_of(text.substr(first, text.size() - end.size() - first)), indent);
}

/// A variable or alias, `TYPE NAME = VALUE;`, `TYPE NAME{};` or `TYPE NAME;`: broken before its
/// value, and before its name where the type and the name do not fit together.
std::optional<std::string> variable(std::string_view text, std::size_t indent) {
  constexpr std::string_view equals = " = ";
  if (!text.ends_with(';') || text.starts_with("return ")) return std::nullopt;
  const std::size_t sign = find_word(text, equals);
  const bool has_value = sign != nowhere;
  const std::size_t end = text.size() - (text.ends_with("{};") ? 3 : 1);
  const std::string_view left = text.substr(0, has_value ? sign : end);
  if (find_outside(left, '(') != nowhere || find_outside(left, '{') != nowhere) return std::nullopt;
  constexpr std::size_t deeper = 4;
  const auto below = [&](std::size_t depth, std::string_view rest) {
    return "\n" + blanks(indent + depth * deeper) + std::string(rest);
  };
  const std::string value(has_value ? text.substr(sign + equals.size()) : std::string_view());
  if (has_value && indent + left.size() + 2 <= line_width) {
    return std::string(left) + " =" + below(1, value);
  }
  const std::size_t blank = find_last_outside(left, ' ');
  if (blank == nowhere) return std::nullopt;
  const std::string type(left.substr(0, blank));
  const std::string_view name = left.substr(blank + 1);
  const std::string_view rest = text.substr(blank + 1);
  if (!has_value || indent + deeper + rest.size() <= line_width) return type + below(1, rest);
  const std::size_t angle = name.find('<');
  if (indent + deeper + name.size() + 2 <= line_width || angle == nowhere) {
    return type + below(1, name) + " =" + below(2, value);
  }
  // A template argument fills the line.
  return type + " " + std::string(name.substr(0, angle + 1)) + below(1, name.substr(angle + 1)) +
         " =" + below(1, value);
}

/// The initial values of an array: `int a[] = {1, 2};`.
std::optional<std::string> array(std::string_view text, std::size_t indent) {
  constexpr std::string_view begin = " = {";
  constexpr std::string_view end = "};";
  const std::size_t open = text.find(begin);
  if (open == nowhere || !text.ends_with(end)) return std::nullopt;
  const std::size_t first = open + begin.size();
  List values{.before = std::string(text.substr(0, first)),
              .items = items_of(text.substr(first, text.size() - end.size() - first)),
              .after = std::string(end)};
  constexpr std::size_t deeper = 4;
  for (std::string& item : values.items) {
    if (indent + deeper + item.size() > line_width) item = call(item, indent + deeper);
  }
  return braced_list(values, indent);
}

}  // namespace

std::string broken(std::string_view line) {
  if (line.size() <= line_width) return std::string(line);
  const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
  const std::string_view text = line.substr(indent);
  if (text.starts_with("//") || text.starts_with('#')) return std::string(line);
  std::string result = blanks(indent);
  if (const auto head = class_begin(text, indent)) return result + *head;
  if (const auto whole = constructor(text, indent)) return result + *whole;
  constexpr std::string_view empty = " {}";
  if (text.ends_with(empty)) {
    const auto signature = signature_of(text.substr(0, text.size() - empty.size()), indent);
    if (signature) return result + opening(*signature, indent) + "}";
  }
  if (const auto whole = function(text, indent)) return result + *whole;
  if (const auto values = array(text, indent)) return result + *values;
  if (const auto whole = variable(text, indent)) return result + *whole;
  for (const std::string_view end : {" {", ";"}) {
    if (!text.ends_with(end)) continue;
    const auto signature = signature_of(text.substr(0, text.size() - end.size()), indent);
    if (!signature) continue;
    return result + (end == ";" ? declaration(*signature, indent) : opening(*signature, indent));
  }
  return result + call(text, indent);
}

bool has_long_line(std::string_view text) {
  while (text.size() > line_width) {
    // The last line end that a line of allowed length could have.
    const std::size_t end = text.substr(0, line_width + 1).rfind('\n');
    if (end == nowhere) return true;
    text.remove_prefix(end + 1);
  }
  return false;
}

std::string broken_lines(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    if (line.size() <= line_width) {
      result += line;
    } else {
      result += broken(line);
    }
    if (end == nowhere) break;
    result += '\n';
    text.remove_prefix(end + 1);
  }
  return result;
}

std::string columns(std::string_view text) {
  const std::size_t indent = std::min(text.find_first_not_of(' '), text.size());
  std::vector<std::string> items;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    items.push_back(broken(text.substr(0, end)).substr(indent));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  std::string result;
  for (const std::string& row : table_rows(items, indent)) {
    result.append(blanks(indent)).append(row).append("\n");
  }
  return result;
}

}  // namespace robdef::cpp
