// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "rr/node_id.hpp"
#include "rr/visibility.hpp"

/// What a node says of itself, line by line (docs/howto/logging.md).
namespace RR_VISIBLE rr {

/// How much a line of the log matters: `debug` and `info` for looking into things, `warning` for
/// what a user should know, `error` for what fails.
enum class LogLevel : std::uint8_t { debug, info, warning, error };

/// `debug`, `info`, `warning` or `error`.
std::string_view log_level_name(LogLevel level);

/// One line of the log, in its parts. Texts are views that end with the call they are given to; a
/// peer's are as it sent them, but for `text`, which is printable (rr/printable.hpp).
struct LogRecord {
  std::chrono::system_clock::time_point time{};  ///< when it was written
  LogLevel level = LogLevel::info;               ///< how much it matters
  NodeId node;                                   ///< whose log it is
  std::string_view node_name;                    ///< its name; empty for none
  std::string_view peer;       ///< `10.0.0.5`, `uid 1000`, `intra`; empty: about no connection
  NodeId peer_node;            ///< what the peer says of itself; zero: nothing yet
  std::string_view peer_name;  ///< the same; empty for none
  std::uint32_t session = 0;   ///< the number of this node's endpoint; 0: outside of a session
  std::string_view text;       ///< what has happened
};

/// A record as one line of `key=value` (logfmt), with its line feed:
/// `time=2026-01-31T09:30:00.125Z level=warning node=arm.host peer=10.0.0.5 msg="..."`. Values of
/// other characters than letters, digits and a few marks are strings as in JSON, so that a peer's
/// text begins no line and steers no terminal.
std::string log_line(const LogRecord& record);

/// Writes records as lines of log_line() to a file:
///
///   rr::Node node({.log_record = rr::LogFile("/var/log/robot/node.log")});
///
/// Copies write to the same file. Any thread.
class LogFile {
 public:
  /// What is written, how large the files get, and how many are kept.
  struct Options {
    LogLevel least = LogLevel::info;  ///< what matters less is left out
    /// Bytes. A file that would become larger is renamed to `path.1`, that to `path.2` and so on.
    std::size_t max_size = std::size_t{16} * 1024 * 1024;
    /// How many of these are kept.
    unsigned kept_files = 5;
  };

  /// Opens or makes the file, which its owner alone may read (0600). Throws rr::Error
  /// (invalid_configuration) when that fails, and for what is no regular file, such as a link.
  explicit LogFile(std::string path) : LogFile(std::move(path), Options()) {}
  /// The same with limits of its own.
  LogFile(std::string path, Options options);
  /// Throws rr::Error (io_error) when the file cannot be written.
  void operator()(const LogRecord& record) const;

 private:
  struct State;
  std::shared_ptr<State> state_;
};

/// How StderrLog writes a line.
enum class LogFormat : std::uint8_t {
  text,    ///< `robotraconteur: warning: ...`
  logfmt,  ///< log_line()
};

/// Writes records to standard error, a line with one call of the system. Where that is the journal
/// of systemd, a line begins with its priority (`<4>`), which the journal takes off.
class StderrLog {
 public:
  /// `least`: what matters less is left out.
  explicit StderrLog(LogLevel least, LogFormat format = LogFormat::text);
  /// Writes the record.
  void operator()(const LogRecord& record) const;

 private:
  LogLevel least_;
  LogFormat format_;
  bool is_journal_;
};

}  // namespace rr
