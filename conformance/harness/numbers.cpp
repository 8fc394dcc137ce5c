// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/numbers.hpp"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace rr::conformance {
namespace {

using rr::ElementType;

constexpr std::uint64_t plain_nan64 = 0x7FF8000000000000U;
constexpr std::uint32_t plain_nan32 = 0x7FC00000U;

template <class Bits>
std::string nan_text(Bits bits) {
  char digits[2 * sizeof(Bits)];
  const auto [end, error] = std::to_chars(std::begin(digits), std::end(digits), bits, 16);
  const std::string text(std::begin(digits), end);
  return "NaN:0x" + std::string(2 * sizeof(Bits) - text.size(), '0') + text;
}

[[noreturn]] void refuse(const Json& json) {
  throw std::runtime_error("not a number of this type: " + json.dump().substr(0, 60));
}

template <class Float, class Bits>
Float float_of_text(const Json& json, Bits plain_nan) {
  const auto& text = json.get_ref<const std::string&>();
  if (text == "NaN") return std::bit_cast<Float>(plain_nan);
  if (text == "Infinity") return std::numeric_limits<Float>::infinity();
  if (text == "-Infinity") return -std::numeric_limits<Float>::infinity();
  if (text.starts_with("NaN:0x")) {
    Bits bits = 0;
    const auto [end, error] = std::from_chars(text.data() + 6, text.data() + text.size(), bits, 16);
    if (error == std::errc{} && end == text.data() + text.size()) return std::bit_cast<Float>(bits);
  }
  refuse(json);
}

template <class T>
T read(const std::byte* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

template <class T>
void append(Bytes& bytes, const T& value) {
  const auto* begin = reinterpret_cast<const std::byte*>(&value);
  bytes.insert(bytes.end(), begin, begin + sizeof value);
}

Json json_of_number(ElementType type, const std::byte* at) {
  switch (type) {
    case ElementType::double_:
      return json_of_double(read<double>(at));
    case ElementType::single:
      return json_of_single(read<float>(at));
    case ElementType::int8:
      return read<std::int8_t>(at);
    case ElementType::uint8:
      return read<std::uint8_t>(at);
    case ElementType::int16:
      return read<std::int16_t>(at);
    case ElementType::uint16:
      return read<std::uint16_t>(at);
    case ElementType::int32:
      return read<std::int32_t>(at);
    case ElementType::uint32:
      return read<std::uint32_t>(at);
    case ElementType::int64:
      return std::to_string(read<std::int64_t>(at));
    case ElementType::uint64:
      return std::to_string(read<std::uint64_t>(at));
    case ElementType::cdouble:
      return Json::array({json_of_double(read<double>(at)), json_of_double(read<double>(at + 8))});
    case ElementType::csingle:
      return Json::array({json_of_single(read<float>(at)), json_of_single(read<float>(at + 4))});
    case ElementType::bool_:
      return read<std::uint8_t>(at) != 0;
    default:
      throw std::runtime_error("no number type: " + std::to_string(static_cast<int>(type)));
  }
}

void append_number(ElementType type, const Json& json, Bytes& bytes) {
  switch (type) {
    case ElementType::double_:
      return append(bytes, double_of_json(json));
    case ElementType::single:
      return append(bytes, single_of_json(json));
    case ElementType::int8:
      return append(bytes, integer_of_json<std::int8_t>(json));
    case ElementType::uint8:
      return append(bytes, integer_of_json<std::uint8_t>(json));
    case ElementType::int16:
      return append(bytes, integer_of_json<std::int16_t>(json));
    case ElementType::uint16:
      return append(bytes, integer_of_json<std::uint16_t>(json));
    case ElementType::int32:
      return append(bytes, integer_of_json<std::int32_t>(json));
    case ElementType::uint32:
      return append(bytes, integer_of_json<std::uint32_t>(json));
    case ElementType::int64:
      return append(bytes, integer_of_json<std::int64_t>(json));
    case ElementType::uint64:
      return append(bytes, integer_of_json<std::uint64_t>(json));
    case ElementType::cdouble:
      append(bytes, double_of_json(json.at(0)));
      return append(bytes, double_of_json(json.at(1)));
    case ElementType::csingle:
      append(bytes, single_of_json(json.at(0)));
      return append(bytes, single_of_json(json.at(1)));
    case ElementType::bool_:
      return append(bytes, static_cast<std::uint8_t>(json.get<bool>()));
    default:
      throw std::runtime_error("no number type: " + std::to_string(static_cast<int>(type)));
  }
}

}  // namespace

Json json_of_double(double value) {
  if (std::isfinite(value)) return value;
  if (std::isinf(value)) return value > 0 ? "Infinity" : "-Infinity";
  const auto bits = std::bit_cast<std::uint64_t>(value);
  return bits == plain_nan64 ? "NaN" : nan_text(bits);
}

Json json_of_single(float value) {
  if (!std::isfinite(value)) {
    if (std::isinf(value)) return value > 0 ? "Infinity" : "-Infinity";
    const auto bits = std::bit_cast<std::uint32_t>(value);
    return bits == plain_nan32 ? "NaN" : nan_text(bits);
  }
  // The shortest decimal of the single, as the double that prints the same. Without an exponent,
  // large ones would be written with all their digits.
  char digits[32];
  const auto written =
      std::to_chars(std::begin(digits), std::end(digits), value, std::chars_format::scientific);
  double wide = 0;
  std::from_chars(std::begin(digits), written.ptr, wide);
  return wide;
}

double double_of_json(const Json& json) {
  if (json.is_string()) return float_of_text<double>(json, plain_nan64);
  if (!json.is_number()) refuse(json);
  return json.get<double>();
}

float single_of_json(const Json& json) {
  if (json.is_string()) return float_of_text<float>(json, plain_nan32);
  if (!json.is_number()) refuse(json);
  return static_cast<float>(json.get<double>());
}

template <class T>
T integer_of_json(const Json& json) {
  T value{};
  const std::string text = json.is_string()           ? json.get<std::string>()
                           : json.is_number_integer() ? json.dump()
                                                      : std::string();
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc{} || end != text.data() + text.size()) refuse(json);
  return value;
}

template std::int8_t integer_of_json<std::int8_t>(const Json&);
template std::uint8_t integer_of_json<std::uint8_t>(const Json&);
template std::int16_t integer_of_json<std::int16_t>(const Json&);
template std::uint16_t integer_of_json<std::uint16_t>(const Json&);
template std::int32_t integer_of_json<std::int32_t>(const Json&);
template std::uint32_t integer_of_json<std::uint32_t>(const Json&);
template std::int64_t integer_of_json<std::int64_t>(const Json&);
template std::uint64_t integer_of_json<std::uint64_t>(const Json&);

Json json_of_numbers(rr::ElementType type, std::span<const std::byte> payload) {
  const std::size_t size = rr::item_size(type);
  Json list = Json::array();
  for (std::size_t at = 0; at + size <= payload.size(); at += size) {
    if (type == ElementType::bool_ && static_cast<unsigned>(payload[at]) > 1) return nullptr;
    list.push_back(json_of_number(type, payload.data() + at));
  }
  return list;
}

Bytes numbers_of_json(rr::ElementType type, const Json& list) {
  Bytes bytes;
  for (const Json& item : list) append_number(type, item, bytes);
  return bytes;
}

}  // namespace rr::conformance
