// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/replay/words.hpp"

#include <array>
#include <charconv>
#include <cstring>
#include <type_traits>

#include "rr/number.hpp"

namespace rr::replay {
namespace {

template <class T>
std::string shortest(T value) {
  std::array<char, 64> text;
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

template <class T>
T item(const ElementTree& element, std::size_t offset) {
  T value{};
  std::memcpy(&value, element.payload.data() + offset, sizeof value);
  return value;
}

template <class T>
std::string complex_at(const ElementTree& element, std::size_t offset) {
  const std::string imaginary = shortest(item<T>(element, offset + sizeof(T)));
  return shortest(item<T>(element, offset)) + (imaginary.starts_with('-') ? "" : "+") + imaginary +
         "i";
}

// Bytes of the UTF-8 sequence at the front of `text`; 0 when there is none.
std::size_t sequence_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  const std::size_t length = first < 0x80                     ? 1
                             : first >= 0xC2 && first < 0xE0  ? 2
                             : first >= 0xE0 && first < 0xF0  ? 3
                             : first >= 0xF0 && first <= 0xF4 ? 4
                                                              : 0;
  if (length == 0 || length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  return length;
}

std::string hexadecimal(unsigned char byte) {
  constexpr std::string_view digits = "0123456789abcdef";
  return {'\\', 'x', digits[byte >> 4], digits[byte & 0xF]};
}

std::string numbers(const ElementTree& element, const Shortening& shortening) {
  const std::size_t count = items_of(element);
  if (count == 1) return " " + number_at(element, 0);
  std::string text = "[" + std::to_string(count) + "] [";
  for (std::size_t i = 0; i < count; ++i) {
    if (i != 0) text += ", ";
    if (i == shortening.items) {
      text += "...";
      break;
    }
    text += number_at(element, i);
  }
  return text + "]";
}

std::string nested(const ElementTree& element, const Shortening& shortening) {
  std::string text = element.type_name.empty() ? "" : " " + element.type_name;
  text += " {";
  std::size_t shown = 0;
  for (const ElementTree& inner : element.elements) {
    if (shown != 0) text += ", ";
    if (shown++ == shortening.items) {
      text += "... " + std::to_string(element.elements.size()) + " in all";
      break;
    }
    text += text_of(inner, shortening);
  }
  return text + "}";
}

}  // namespace

std::string quoted(std::string_view text, std::size_t limit) {
  const bool is_cut = text.size() > limit;
  const std::size_t size = text.size();
  std::string result = "\"";
  std::size_t taken = 0;
  while (!text.empty() && taken < limit) {
    const char first = text.front();
    std::size_t length = sequence_length(text);
    if (length == 0 || static_cast<unsigned char>(first) < 0x20 || first == 0x7F) {
      length = 1;
      result += first == '\n'   ? "\\n"
                : first == '\t' ? "\\t"
                : first == '\r' ? "\\r"
                                : hexadecimal(static_cast<unsigned char>(first));
    } else {
      if (first == '"' || first == '\\') result += '\\';
      result += text.substr(0, length);
    }
    text.remove_prefix(length);
    taken += length;
  }
  result += "\"";
  return is_cut ? result + "... " + std::to_string(size) + " bytes" : result;
}

std::size_t items_of(const ElementTree& element) {
  const std::size_t size = item_size(element.type);
  return size == 0 ? 0 : element.payload.size() / size;
}

std::string_view string_of(const ElementTree& element) {
  return {reinterpret_cast<const char*>(element.payload.data()), element.payload.size()};
}

std::string label_of(const ElementTree& element) {
  constexpr unsigned number_flag = 0x04;  // 02, section 4
  if (!element.name.empty() || (element.flags & number_flag) == 0) return element.name;
  return std::to_string(element.number);
}

std::string number_at(const ElementTree& element, std::size_t index) {
  if (index >= items_of(element) || !is_number(element.type)) return {};
  const std::size_t offset = index * item_size(element.type);
  return with_number(element.type, [&]<class T>(std::type_identity<T>) -> std::string {
    if constexpr (std::is_same_v<T, bool>) {
      const auto value = item<std::uint8_t>(element, offset);
      return value == 0 ? "false" : value == 1 ? "true" : "bool " + std::to_string(value);
    } else if constexpr (std::is_arithmetic_v<T>) {
      return shortest(item<T>(element, offset));
    } else {
      return complex_at<typename T::value_type>(element, offset);
    }
  });
}

std::string text_of(const ElementTree& element, const Shortening& shortening) {
  std::string text = label_of(element) + ": " + name_of(element.type);
  if (element.type == ElementType::string) {
    text += " " + quoted(string_of(element), shortening.bytes);
  } else if (is_nested(element.type)) {
    text += nested(element, shortening);
  } else if (element.type != ElementType::void_) {
    text += numbers(element, shortening);
  }
  return text;
}

std::string place_of(const EntryTree& entry) {
  if (entry.member.empty()) return entry.service_path;
  return entry.service_path.empty() ? entry.member : entry.service_path + "." + entry.member;
}

std::string text_of(const EntryTree& entry, const Shortening& shortening) {
  std::string text = name_of(entry.type);
  const std::string place = place_of(entry);
  if (!place.empty()) text += " " + place;
  if (entry.request_id != 0) text += " id " + std::to_string(entry.request_id);
  if (entry.error != 0) text += " error " + std::to_string(entry.error);
  std::string separator = "  ";
  for (const ElementTree& element : entry.elements) {
    text += separator + text_of(element, shortening);
    separator = ", ";
  }
  return text;
}

}  // namespace rr::replay
