// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/dynamic/type_text.hpp"

#include <charconv>

namespace rr::dynamic {
namespace {

bool take_number(std::string_view& text, std::uint32_t& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end == text.data() || number == any_length) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

// What is between the brackets (06, section 5).
bool take_bounds(std::string_view inside, ArrayBounds& bounds) {
  if (inside.empty() || inside == "0") return true;
  if (inside == "*") {
    bounds.has_dims = true;
    return true;
  }
  std::uint32_t number = 0;
  if (!take_number(inside, number)) return false;
  if (inside.empty() || inside == "-") {
    bounds.minimum = inside.empty() ? number : 0;
    bounds.maximum = number;
    return true;
  }
  bounds.has_dims = true;
  bounds.shape.push_back(number);
  while (!inside.empty()) {
    if (inside.front() != ',') return false;
    inside.remove_prefix(1);
    if (inside.empty()) return bounds.shape.size() == 1;  // `[3,]`
    if (!take_number(inside, number)) return false;
    bounds.shape.push_back(number);
  }
  return true;
}

}  // namespace

std::optional<TypeText> parse_type_text(std::string_view text) {
  std::string plain;
  for (const char c : text) {
    if (c != ' ' && c != '\t') plain += c;
  }
  std::string_view rest = plain;
  TypeText type;
  const std::size_t base = rest.find_first_of("[{");
  type.base = rest.substr(0, base);
  rest.remove_prefix(std::min(base, rest.size()));
  if (type.base.empty()) return std::nullopt;
  if (rest.starts_with('[')) {
    const std::size_t end = rest.find(']');
    if (end == std::string_view::npos) return std::nullopt;
    type.is_array = true;
    type.array = rest.substr(0, end + 1);
    if (!take_bounds(rest.substr(1, end - 1), type.bounds)) return std::nullopt;
    if (type.array == "[0]") type.array = "[]";
    rest.remove_prefix(end + 1);
  }
  type.container_text = rest;
  if (rest == "{list}") {
    type.container = Kind::list;
  } else if (rest == "{int32}") {
    type.container = Kind::int_map;
  } else if (rest == "{string}") {
    type.container = Kind::string_map;
  } else if (!rest.empty()) {
    return std::nullopt;
  }
  return type;
}

}  // namespace rr::dynamic
