// SPDX-License-Identifier: Apache-2.0
#include "compiler/output/json.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "compiler/output/escape.hpp"

namespace robdef {
namespace {

template <class Number>
std::string digits(Number number) {
  std::array<char, 32> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number).ptr;
  return {buffer.data(), end};
}

// Bytes of the UTF-8 sequence at `at`; 0 if there is none (overlong forms, surrogates, cut ends).
std::size_t sequence_length(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(at);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || at + length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(at + i) & 0xC0) != 0x80) return 0;
  }
  const unsigned char second = byte(at + 1);
  const bool is_overlong = (lead == 0xE0 && second < 0xA0) || (lead == 0xF0 && second < 0x90);
  const bool is_outside = (lead == 0xED && second > 0x9F) || (lead == 0xF4 && second > 0x8F);
  return is_overlong || is_outside ? 0 : length;
}

constexpr std::string_view hex_digits = "0123456789abcdef";

}  // namespace

std::string json_string(std::string_view text) {
  std::string out = "\"";
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = sequence_length(text, at);
    if (length == 0) {
      out += "\xEF\xBF\xBD";
    } else if (length == 1) {
      append_escaped(out, text[at], hex_digits);
    } else {
      out += text.substr(at, length);
    }
    at += length == 0 ? 1 : length;
  }
  return out += '"';
}

JsonWriter& JsonWriter::begin_object() { return begin('{'); }
JsonWriter& JsonWriter::end_object() { return end('}'); }
JsonWriter& JsonWriter::begin_array() { return begin('['); }
JsonWriter& JsonWriter::end_array() { return end(']'); }

JsonWriter& JsonWriter::begin(char bracket) {
  before_value();
  text_ += bracket;
  levels_.push_back({bracket == '{', true});
  return *this;
}

JsonWriter& JsonWriter::end(char bracket) {
  if (levels_.empty() || levels_.back().is_object != (bracket == '}') || has_key_) {
    throw std::logic_error("JSON that does not nest");
  }
  const bool was_empty = levels_.back().is_empty;
  levels_.pop_back();
  if (!was_empty) break_line();
  text_ += bracket;
  is_done_ = levels_.empty();
  return *this;
}

JsonWriter& JsonWriter::key(std::string_view name) {
  if (levels_.empty() || !levels_.back().is_object || has_key_) {
    throw std::logic_error("a JSON key outside an object");
  }
  if (!levels_.back().is_empty) text_ += ',';
  levels_.back().is_empty = false;
  break_line();
  text_ += json_string(name);
  text_ += layout_ == Layout::indented ? ": " : ":";
  has_key_ = true;
  return *this;
}

void JsonWriter::before_value() {
  if (is_done_) throw std::logic_error("a second JSON document");
  if (levels_.empty()) return;
  if (levels_.back().is_object) {
    if (!std::exchange(has_key_, false)) throw std::logic_error("a JSON member without a key");
    return;
  }
  if (!levels_.back().is_empty) text_ += ',';
  levels_.back().is_empty = false;
  break_line();
}

void JsonWriter::break_line() {
  if (layout_ == Layout::one_line) return;
  text_ += '\n';
  text_.append(2 * levels_.size(), ' ');
}

JsonWriter& JsonWriter::value(std::string_view text) {
  before_value();
  text_ += json_string(text);
  is_done_ = levels_.empty();
  return *this;
}

JsonWriter& JsonWriter::value(bool truth) {
  before_value();
  text_ += truth ? "true" : "false";
  is_done_ = levels_.empty();
  return *this;
}

JsonWriter& JsonWriter::value(double number) {
  if (!std::isfinite(number)) return null();
  before_value();
  text_ += digits(number);
  is_done_ = levels_.empty();
  return *this;
}

JsonWriter& JsonWriter::integer(std::int64_t number) {
  before_value();
  text_ += digits(number);
  is_done_ = levels_.empty();
  return *this;
}

JsonWriter& JsonWriter::natural(std::uint64_t number) {
  before_value();
  text_ += digits(number);
  is_done_ = levels_.empty();
  return *this;
}

JsonWriter& JsonWriter::null() {
  before_value();
  text_ += "null";
  is_done_ = levels_.empty();
  return *this;
}

std::string JsonWriter::text() && {
  if (!is_done_) throw std::logic_error("an unfinished JSON document");
  if (layout_ == Layout::indented) text_ += '\n';
  return std::move(text_);
}

}  // namespace robdef
