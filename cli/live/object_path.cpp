// SPDX-License-Identifier: Apache-2.0
#include "cli/live/object_path.hpp"

#include <cctype>
#include <charconv>
#include <cstdint>
#include <rr/error.hpp>
#include <utility>

namespace robdef::live {
namespace {

[[noreturn]] void refuse_path(std::string_view text) {
  refuse("`" + std::string(text) + "` is no path of an object; they look so: lights[0].lamp");
}

bool is_name(std::string_view text) {
  for (const char letter : text) {
    if (std::isalnum(static_cast<unsigned char>(letter)) == 0 && letter != '_') return false;
  }
  return !text.empty();
}

std::string decode(std::string_view index, std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < index.size(); ++i) {
    if (index[i] != '%') {
      decoded += index[i];
      continue;
    }
    unsigned byte = 0;
    const std::string_view digits = index.substr(i + 1, 2);
    const char* const end = digits.data() + digits.size();
    const auto read = std::from_chars(digits.data(), end, byte, 16);
    if (digits.size() != 2 || read.ec != std::errc() || read.ptr != end) refuse_path(text);
    decoded += static_cast<char>(byte);
    i += 2;
  }
  return decoded;
}

std::string encode(std::string_view index) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string encoded;
  for (const char letter : index) {
    const auto byte = static_cast<unsigned char>(letter);
    if (letter != '%' && letter != ']' && byte >= ' ') {
      encoded += letter;
      continue;
    }
    encoded += {'%', digits[byte / 16], digits[byte % 16]};
  }
  return encoded;
}

std::int32_t number_in(const PathStep& step) {
  std::int32_t number = 0;
  const char* const end = step.index->data() + step.index->size();
  const auto read = std::from_chars(step.index->data(), end, number);
  if (step.index->empty() || read.ec != std::errc() || read.ptr != end) {
    refuse("member " + step.name + ": expected an index of type int32, got `" + *step.index + "`");
  }
  return number;
}

rr::dynamic::Object step_into(const rr::dynamic::Object& object, const PathStep& step) {
  const rr::dynamic::MemberDescription member = object.member(step.name);
  if (member.kind != rr::MemberKind::objref || !step.index) return object.object(step.name);
  if (member.index != rr::IndexForm::int32) return object.object(step.name, *step.index);
  return object.object(step.name, number_in(step));
}

}  // namespace

void refuse(const std::string& what) { throw rr::Error(rr::ErrorCode::invalid_argument, what); }

ObjectPath parse_object_path(std::string_view text) {
  ObjectPath path;
  std::string_view rest = text;
  while (!rest.empty()) {
    const std::size_t end = rest.find_first_of(".[");
    PathStep step{std::string(rest.substr(0, end)), std::nullopt};
    if (!is_name(step.name)) refuse_path(text);
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end);
    if (rest.starts_with('[')) {
      const std::size_t close = rest.find(']');
      if (close == std::string_view::npos) refuse_path(text);
      step.index = decode(rest.substr(1, close - 1), text);
      rest.remove_prefix(close + 1);
    }
    path.push_back(std::move(step));
    if (rest.empty()) break;
    if (!rest.starts_with('.') || rest.size() == 1) refuse_path(text);
    rest.remove_prefix(1);
  }
  return path;
}

MemberPath parse_member_path(std::string_view text) {
  ObjectPath path = parse_object_path(text);
  if (path.empty()) refuse("no member given");
  if (path.back().index) {
    refuse("`" + std::string(text) +
           "` is an object; name one of its members: " + std::string(text) + ".NAME");
  }
  std::string member = std::move(path.back().name);
  path.pop_back();
  return {std::move(path), std::move(member)};
}

std::string text_of(const ObjectPath& path) {
  std::string text;
  for (const PathStep& step : path) {
    text += (text.empty() ? "" : ".") + step.name;
    if (step.index) text += "[" + encode(*step.index) + "]";
  }
  return text;
}

rr::dynamic::Object object_at(rr::dynamic::Object object, const ObjectPath& path) {
  for (const PathStep& step : path) object = step_into(object, step);
  return object;
}

}  // namespace robdef::live
