// SPDX-License-Identifier: Apache-2.0
// Where lines of the log go: standard error, or a file.
#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <utility>

#include "rr/log.hpp"
#include "rr/printable.hpp"
#include "runtime/cpp/src/channel/rotating_file.hpp"
#include "runtime/cpp/src/codec/json_text.hpp"
#include "runtime/cpp/src/platform/clock.hpp"
#include "runtime/cpp/src/platform/files.hpp"
#include "runtime/cpp/src/platform/service_manager.hpp"

namespace rr {
namespace {

// Of one value; the text of a line is shorter.
constexpr std::size_t longest_value = 4096;

bool is_plain(std::string_view text) {
  constexpr std::string_view marks = "-_.:/+%*@{}";
  return !text.empty() && text.size() <= longest_value &&
         std::all_of(text.begin(), text.end(), [&](unsigned char c) {
           return c < 0x80 && (std::isalnum(c) != 0 ||
                               marks.find(static_cast<char>(c)) != std::string_view::npos);
         });
}

void add(std::string& line, std::string_view key, std::string_view value) {
  if (value.empty()) return;
  line += ' ';
  line += key;
  line += '=';
  if (is_plain(value)) {
    line += value;
  } else {
    codec::add_json_text(line, value, longest_value);
  }
}

// Those of syslog, which the journal knows.
char priority_of(LogLevel level) {
  constexpr std::array<char, 4> priorities{'7', '6', '4', '3'};
  return priorities.at(static_cast<std::size_t>(level));
}

}  // namespace

std::string_view log_level_name(LogLevel level) {
  constexpr std::array<std::string_view, 4> names{"debug", "info", "warning", "error"};
  return names.at(static_cast<std::size_t>(level));
}

std::string log_line(const LogRecord& record) {
  std::string line = "time=" + platform::utc_text(record.time, 3);
  add(line, "level", log_level_name(record.level));
  add(line, "node", record.node_name);
  if (!record.node.is_any()) add(line, "node_id", record.node.text());
  add(line, "peer", record.peer);
  if (!record.peer_node.is_any()) add(line, "peer_node", record.peer_node.text());
  add(line, "peer_name", printable(record.peer_name));
  if (record.session != 0) add(line, "session", std::to_string(record.session));
  line += " msg=";
  codec::add_json_text(line, record.text, longest_value);
  return line + "\n";
}

struct LogFile::State {
  State(std::string path, const Options& options)
      : least(options.least), file(std::move(path), options.max_size, options.kept_files) {}

  const LogLevel least;
  channel::RotatingFile file;
};

LogFile::LogFile(std::string path, Options options)
    : state_(std::make_shared<State>(std::move(path), options)) {}

void LogFile::operator()(const LogRecord& record) const {
  if (record.level >= state_->least) state_->file.write(log_line(record));
}

StderrLog::StderrLog(LogLevel least, LogFormat format)
    : least_(least), format_(format), is_journal_(platform::is_stderr_the_journal()) {}

void StderrLog::operator()(const LogRecord& record) const {
  if (record.level < least_) return;
  std::string line;
  if (is_journal_) line += {'<', priority_of(record.level), '>'};
  if (format_ == LogFormat::logfmt) {
    line += log_line(record);
  } else {
    line += "robotraconteur: " + std::string(log_level_name(record.level)) + ": " +
            std::string(record.text) + "\n";
  }
  constexpr int standard_error = 2;
  // There is nowhere else to say that it cannot be written.
  static_cast<void>(platform::write_all(standard_error, std::as_bytes(std::span(line))));
}

}  // namespace rr
