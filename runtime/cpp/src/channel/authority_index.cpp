// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/authority_index.hpp"

#include <array>
#include <cctype>
#include <charconv>
#include <fstream>
#include <optional>
#include <string_view>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/private_files.hpp"
#include "runtime/cpp/src/platform/clock.hpp"

namespace rr::channel {
namespace {

using WallClock = std::chrono::system_clock;

constexpr std::string_view first_line = "robdef ca index 1";
constexpr std::string_view revoked_mark = "revoked ";
constexpr const char* time_form = "%Y-%m-%dT%H:%M:%SZ";

std::string text_of_time(WallClock::time_point time) {
  const std::tm parts = platform::utc(WallClock::to_time_t(time));
  std::array<char, 64> text{};
  return {text.data(), std::strftime(text.data(), text.size(), time_form, &parts)};
}

// 0 where there is none.
int number_in(std::string_view digits) {
  int number = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return number;
}

std::optional<WallClock::time_point> time_in(std::string_view text) {
  if (text.size() != std::string_view("2026-01-31T09:30:00Z").size()) return std::nullopt;
  std::tm parts{};
  parts.tm_year = number_in(text.substr(0, 4)) - 1900;
  parts.tm_mon = number_in(text.substr(5, 2)) - 1;
  parts.tm_mday = number_in(text.substr(8, 2));
  parts.tm_hour = number_in(text.substr(11, 2));
  parts.tm_min = number_in(text.substr(14, 2));
  parts.tm_sec = number_in(text.substr(17, 2));
  const WallClock::time_point time = platform::time_of_utc(parts);
  // Of numbers that are out of bounds, and whatever else is there, comes another text.
  if (text_of_time(time) != text) return std::nullopt;
  return time;
}

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::size_t begin = 0;
  while (begin <= line.size()) {
    const std::size_t end = std::min(line.find('\t', begin), line.size());
    fields.push_back(line.substr(begin, end - begin));
    begin = end + 1;
  }
  return fields;
}

std::optional<IssuedCertificate> certificate_in(const std::string& line) {
  const std::vector<std::string> fields = fields_of(line);
  if (fields.size() != 6) return std::nullopt;
  const auto node = NodeId::parse(fields[1]);
  const auto begin = time_in(fields[2]);
  const auto end = time_in(fields[3]);
  if (serial_in(fields[0]).empty() || !node || !begin || !end) return std::nullopt;
  IssuedCertificate read{serial_in(fields[0]), *node, fields[5], *begin, *end, std::nullopt};
  if (fields[4].starts_with(revoked_mark)) {
    read.revoked = time_in(fields[4].substr(revoked_mark.size()));
    if (!read.revoked) return std::nullopt;
  } else if (fields[4] != "issued") {
    return std::nullopt;
  }
  return read;
}

}  // namespace

std::string serial_in(const std::string& text) {
  std::string digits;
  for (const char letter : text) {
    if (letter == ':') continue;
    if (std::isxdigit(static_cast<unsigned char>(letter)) == 0) return {};
    digits += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  }
  const std::size_t first = digits.find_first_not_of('0');
  return first == std::string::npos ? std::string() : digits.substr(first);
}

std::vector<IssuedCertificate> read_index(const std::string& file) {
  std::ifstream from(file, std::ios::binary);
  std::vector<IssuedCertificate> issued;
  std::size_t number = 0;
  std::string line;
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorCode::invalid_configuration, "`" + file + "`: " + why);
  };
  if (!from) refuse("it cannot be read");
  while (std::getline(from, line)) {
    if (++number == 1) {
      if (line != first_line) refuse("it is no index of this version");
      continue;
    }
    auto certificate = certificate_in(line);
    if (!certificate) refuse("line " + std::to_string(number) + " cannot be understood");
    issued.push_back(std::move(*certificate));
  }
  if (from.bad() || number == 0) refuse("it cannot be read");
  return issued;
}

void write_index(const std::string& file, const std::vector<IssuedCertificate>& issued) {
  std::string text = std::string(first_line) + "\n";
  for (const IssuedCertificate& each : issued) {
    text += each.serial + '\t' + each.node.text() + '\t' + text_of_time(each.not_before) + '\t' +
            text_of_time(each.not_after) + '\t' +
            (each.revoked ? std::string(revoked_mark) + text_of_time(*each.revoked) : "issued") +
            '\t' + each.name + '\n';
  }
  replace_file(file, text, secret_file);
}

}  // namespace rr::channel
