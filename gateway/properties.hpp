// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <charconv>
#include <cstdint>
#include <ctime>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/carrier.hpp"

/// Texts and numbers in messages.
namespace rr::gateway {

/// The bytes of a text.
inline Bytes bytes_of(std::string_view text) {
  const auto* const bytes = reinterpret_cast<const std::byte*>(text.data());
  return {bytes, bytes + text.size()};
}

/// The reverse.
inline std::string text_of(const Bytes& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// 16 hexadecimal digits.
inline std::string hex_text(std::uint64_t number) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string text(16, '0');
  for (std::size_t i = 16; i-- > 0; number >>= 4U) text[i] = digits[number & 0xFU];
  return text;
}

/// The same of a random number.
inline std::string random_hex() {
  std::random_device device;
  return hex_text((std::uint64_t{device()} << 32U) | device());
}

/// A property as a number; nothing for what is none.
inline std::optional<std::uint64_t> number_property(const Message& message, std::string_view name,
                                                    int base = 10) {
  const auto text = message.find(name);
  if (!text) return std::nullopt;
  std::uint64_t number = 0;
  const char* const end = text->data() + text->size();
  const auto result = std::from_chars(text->data(), end, number, base);
  if (result.ec != std::errc() || result.ptr != end) return std::nullopt;
  return number;
}

/// The same with a sign.
inline std::optional<std::int32_t> signed_property(const Message& message, std::string_view name) {
  const auto text = message.find(name);
  if (!text) return std::nullopt;
  std::int32_t number = 0;
  const char* const end = text->data() + text->size();
  const auto result = std::from_chars(text->data(), end, number);
  if (result.ec != std::errc() || result.ptr != end) return std::nullopt;
  return number;
}

/// `2026-11-27T11:44:16Z` of nanoseconds since 1970.
inline std::string date_text(std::uint64_t nanoseconds) {
  const auto seconds = static_cast<std::time_t>(nanoseconds / 1'000'000'000);
  std::tm parts{};
  ::gmtime_r(&seconds, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text.data();
}

/// `1,2,3`.
inline std::string list_text(const std::vector<std::uint64_t>& numbers) {
  std::string text;
  for (const std::uint64_t number : numbers) {
    if (!text.empty()) text += ',';
    text += std::to_string(number);
  }
  return text;
}

/// A property as such a list; nothing for what is none.
inline std::optional<std::vector<std::uint64_t>> numbers_property(const Message& message,
                                                                  std::string_view name) {
  const auto text = message.find(name);
  if (!text) return std::nullopt;
  std::vector<std::uint64_t> numbers;
  const char* at = text->data();
  const char* const end = at + text->size();
  for (;;) {
    const auto result = std::from_chars(at, end, numbers.emplace_back());
    if (result.ec != std::errc()) return std::nullopt;
    if (result.ptr == end) return numbers;
    if (*result.ptr != ',') return std::nullopt;
    at = result.ptr + 1;
  }
}

}  // namespace rr::gateway
