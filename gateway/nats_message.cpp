// SPDX-License-Identifier: Apache-2.0
#include "gateway/nats_message.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

#include "gateway/nats_subjects.hpp"

namespace rr::gateway {
namespace {

constexpr std::string_view header_digits = "0123456789ABCDEF";
constexpr std::string_view correlation_header = "rr-correlation";
constexpr std::string_view expiry_header = "rr-expiry";
constexpr std::size_t line_of_version = 12;  // `NATS/1.0`, and the empty line at the end
constexpr std::size_t around_header = 4;     // colon, space, end of line

int value_of_digit(char c) {
  const char upper = c >= 'a' && c <= 'f' ? static_cast<char>(c - 'a' + 'A') : c;
  const std::size_t at = header_digits.find(upper);
  return at == std::string_view::npos ? -1 : static_cast<int>(at);
}

/// The byte of two digits; -1 for none.
int byte_at(std::string_view text, std::size_t at) {
  if (at + 2 > text.size() || value_of_digit(text[at]) < 0 || value_of_digit(text[at + 1]) < 0)
    return -1;
  return value_of_digit(text[at]) * 16 + value_of_digit(text[at + 1]);
}

void add_hex(std::string& text, unsigned char byte) {
  text += {header_digits[byte >> 4U], header_digits[byte & 0xFU]};
}

/// The library's own headers have capital letters.
bool is_property_name(std::string_view name) {
  return !name.empty() && !name.starts_with("rr-") &&
         std::ranges::all_of(name, [](char c) { return (c >= 'a' && c <= 'z') || c == '-'; });
}

std::string correlation_text(const Bytes& correlation) {
  std::string text;
  for (const std::byte byte : correlation) add_hex(text, static_cast<unsigned char>(byte));
  return text;
}

Bytes correlation_of(std::string_view text) {
  Bytes bytes;
  for (std::size_t i = 0; i < text.size(); i += 2) {
    const int byte = byte_at(text, i);
    if (byte < 0) return {};
    bytes.push_back(static_cast<std::byte>(byte));
  }
  return bytes;
}

}  // namespace

std::size_t size_of(const NatsMessage& message) {
  std::size_t size = message.payload.size();
  if (!message.headers.empty()) size += line_of_version;
  for (const auto& [name, value] : message.headers) {
    size += name.size() + value.size() + around_header;
  }
  return size;
}

std::optional<std::string_view> header_of(const NatsMessage& message, std::string_view name) {
  for (const auto& [key, value] : message.headers) {
    if (key == name) return value;
  }
  return std::nullopt;
}

std::string header_text(std::string_view value) {
  if (value.empty()) return "%";
  std::string text;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const char c = value[i];
    const bool is_end = i == 0 || i + 1 == value.size();
    if (c > '~' || c < ' ' || c == '%' || (c == ' ' && is_end)) {
      text += '%';
      add_hex(text, static_cast<unsigned char>(c));
    } else {
      text += c;
    }
  }
  return text;
}

std::string value_of_header(std::string_view text) {
  if (text == "%") return {};
  std::string value;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int byte = text[i] == '%' ? byte_at(text, i + 1) : -1;
    if (byte < 0) {
      value += text[i];
    } else {
      value += static_cast<char>(byte);
      i += 2;
    }
  }
  return value;
}

NatsMessage nats_message_of(const Message& message) {
  NatsMessage result;
  result.subject = subject_of(message.topic);
  if (!message.response_topic.empty()) result.reply = subject_of(message.response_topic);
  result.payload = message.payload;
  for (const auto& [name, value] : message.properties) {
    result.headers.emplace_back(name, header_text(value));
  }
  if (!message.correlation.empty()) {
    result.headers.emplace_back(correlation_header, correlation_text(message.correlation));
  }
  if (message.expiry) {
    result.headers.emplace_back(expiry_header, std::to_string(message.expiry->count()));
  }
  return result;
}

std::optional<Message> message_of(NatsMessage message) {
  auto topic = topic_of(message.subject);
  if (!topic) return std::nullopt;
  Message result{*std::move(topic), std::move(message.payload)};
  if (!message.reply.empty()) result.response_topic = topic_of(message.reply).value_or("");
  for (const auto& [name, value] : message.headers) {
    if (is_property_name(name)) result.properties.emplace_back(name, value_of_header(value));
  }
  if (const auto text = header_of(message, correlation_header)) {
    result.correlation = correlation_of(*text);
  }
  return result;
}

std::optional<std::chrono::seconds> expiry_of(const NatsMessage& message) {
  const auto text = header_of(message, expiry_header);
  if (!text) return std::nullopt;
  std::uint32_t seconds = 0;
  const auto result = std::from_chars(text->data(), text->data() + text->size(), seconds);
  if (result.ec != std::errc() || result.ptr != text->data() + text->size()) return std::nullopt;
  return std::chrono::seconds(seconds);
}

}  // namespace rr::gateway
