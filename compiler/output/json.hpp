// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace robdef {

/// Writes one JSON document (RFC 8259) from front to back, keys in the order of the calls, so the
/// same calls always give the same bytes.
///
///   JsonWriter json;
///   json.begin_object().key("name").value("a").key("sizes").begin_array().value(1).end_array();
///   json.end_object();
///   std::string text = std::move(json).text();
///
/// Calls must nest properly and each member of an object needs its key; otherwise std::logic_error.
class JsonWriter {
 public:
  enum class Layout {
    indented,  ///< two blanks a level, one value a line, a line end at the end
    one_line,  ///< no blanks, no line end
  };

  explicit JsonWriter(Layout layout = Layout::indented) : layout_(layout) {}

  JsonWriter& begin_object();
  JsonWriter& end_object();
  JsonWriter& begin_array();
  JsonWriter& end_array();
  JsonWriter& key(std::string_view name);

  /// Bytes that are not UTF-8 become U+FFFD.
  JsonWriter& value(std::string_view text);
  JsonWriter& value(const char* text) { return value(std::string_view(text)); }
  JsonWriter& value(const std::string& text) { return value(std::string_view(text)); }
  JsonWriter& value(bool truth);
  /// The shortest decimal that reads back as the same double; null for infinities and NaN.
  JsonWriter& value(double number);
  template <std::signed_integral Integer>
  JsonWriter& value(Integer number) {
    return integer(static_cast<std::int64_t>(number));
  }
  template <std::unsigned_integral Integer>
  requires(!std::same_as<Integer, bool>) JsonWriter& value(Integer number) {
    return natural(static_cast<std::uint64_t>(number));
  }
  JsonWriter& null();

  /// `key(name)` followed by `value(what)`.
  template <class Value>
  JsonWriter& member(std::string_view name, const Value& what) {
    return key(name).value(what);
  }

  /// The finished document.
  [[nodiscard]] std::string text() &&;

 private:
  struct Level {
    bool is_object = false;
    bool is_empty = true;
  };

  JsonWriter& integer(std::int64_t number);
  JsonWriter& natural(std::uint64_t number);
  JsonWriter& begin(char bracket);
  JsonWriter& end(char bracket);
  void before_value();
  void break_line();

  Layout layout_;
  std::string text_;
  std::vector<Level> levels_;
  bool has_key_ = false;
  bool is_done_ = false;
};

/// `text` as a JSON string, quotes included: `"`, `\` and control characters escaped, all else as
/// it is; bytes that are not UTF-8 become U+FFFD.
std::string json_string(std::string_view text);

}  // namespace robdef
