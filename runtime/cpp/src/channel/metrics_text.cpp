// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/metrics_text.hpp"

#include <array>
#include <charconv>
#include <utility>

namespace rr::channel {
namespace {

// A label's value: the three characters that would end it, or its line, are escaped.
void add_escaped(std::string& text, std::string_view value) {
  for (const char c : value) {
    if (c == '\n') {
      text += "\\n";
      continue;
    }
    if (c == '"' || c == '\\') text += '\\';
    text += c;
  }
}

std::string number_text(double value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  std::string text(digits.data(), end);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

}  // namespace

void MetricsText::begin(const Family& family) {
  family_ = family.name;
  text_ += "# TYPE " + family_ + " " + std::string(family.type) + "\n";
  if (!family.unit.empty()) text_ += "# UNIT " + family_ + " " + std::string(family.unit) + "\n";
  text_ += "# HELP " + family_ + " ";
  add_escaped(text_, family.help);
  text_ += '\n';
}

void MetricsText::begin_sample(std::string_view suffix, Labels labels) {
  text_ += family_;
  text_ += suffix;
  char before = '{';
  for (const auto& [name, value] : labels) {
    text_ += std::exchange(before, ',');
    text_ += name;
    text_ += "=\"";
    add_escaped(text_, value);
    text_ += '"';
  }
  if (before == ',') text_ += '}';
  text_ += ' ';
}

void MetricsText::sample(std::string_view suffix, Labels labels, std::uint64_t value) {
  begin_sample(suffix, labels);
  text_ += std::to_string(value) + "\n";
}

void MetricsText::sample(std::string_view suffix, Labels labels, double value) {
  begin_sample(suffix, labels);
  text_ += number_text(value) + "\n";
}

void MetricsText::counter(const Family& family, std::uint64_t value) {
  begin(family);
  sample("_total", {}, value);
}

void MetricsText::gauge(const Family& family, std::uint64_t value) {
  begin(family);
  sample("", {}, value);
}

std::string MetricsText::finish() && { return std::move(text_) + "# EOF\n"; }

std::string MetricsText::seconds_text(std::uint64_t nanoseconds) {
  return number_text(static_cast<double>(nanoseconds) / 1e9);
}

}  // namespace rr::channel
