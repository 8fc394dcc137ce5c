// SPDX-License-Identifier: Apache-2.0
#include "cli/option_values.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

#include "runtime/cpp/src/replay/words.hpp"

namespace robdef {
namespace {

template <class Number>
std::optional<Number> number_in(std::string_view text) {
  Number number = 0;
  const char* const end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, number);
  if (text.empty() || result.ec != std::errc() || result.ptr != end) return std::nullopt;
  return number;
}

}  // namespace

std::string take_entry_types(Options& options, const std::string& value) {
  std::size_t begin = 0;
  while (begin <= value.size()) {
    const std::size_t end = std::min(value.find(',', begin), value.size());
    const std::string name = value.substr(begin, end - begin);
    const auto type = rr::replay::entry_type_of(name);
    if (!type) return "`" + name + "` is no type of an entry";
    more(options).recording.entry_types.insert(static_cast<std::uint16_t>(*type));
    begin = end + 1;
  }
  return "";
}

std::string take_connection(Options& options, const std::string& value) {
  more(options).recording.connection = number_in<std::uint32_t>(value);
  return more(options).recording.connection ? "" : "`" + value + "` is no number of a connection";
}

std::string take_tolerance(Options& options, const std::string& value) {
  double number = 0;
  const char* const end = value.data() + value.size();
  const auto [at, error] = std::from_chars(value.data(), end, number);
  const bool is_right = !value.empty() && error == std::errc() && at == end;
  if (!is_right || !(number >= 0) || !std::isfinite(number)) {
    return "`" + value + "` is no number of at least 0";
  }
  more(options).recording.tolerance = number;
  return "";
}

std::string take_port(Options& options, const std::string& value) {
  more(options).recording.port = number_in<std::uint16_t>(value);
  return more(options).recording.port ? "" : "`" + value + "` is no port";
}

std::string take_discover_format(Options& options, const std::string& value) {
  std::string complaint = take_format(options, value);
  if (!complaint.empty() || options.format != Format::line) return complaint;
  return "known here: `text`, `json`";
}

std::string take_discovery_port(Options& options, const std::string& value) {
  const auto port = number_in<std::uint16_t>(value);
  more(options).discover.port = port.value_or(0);
  return more(options).discover.port != 0 ? "" : "`" + value + "` is no port";
}

std::string take_wait(Options& options, const std::string& value) {
  const auto seconds = number_in<std::uint16_t>(value);
  more(options).discover.wait = std::chrono::seconds(seconds.value_or(0));
  return seconds ? "" : "`" + value + "` is no number of seconds";
}

std::string take_interface(Options& options, const std::string& value) {
  more(options).discover.interfaces.push_back(value);
  return value.empty() ? "the value is empty" : "";
}

std::string take_number_of_days(std::optional<int>& days, const std::string& value) {
  days = number_in<int>(value);
  const bool is_right = days && *days > 0 && *days <= 36500;
  return is_right ? "" : "`" + value + "` is no number of days from 1 to 36500";
}

}  // namespace robdef
