// SPDX-License-Identifier: Apache-2.0
// Events as lines of JSON in a file.
#include <array>
#include <cstdio>
#include <ctime>
#include <system_error>
#include <utility>

#include "rr/audit.hpp"
#include "rr/error.hpp"
#include "rr/mutex.hpp"
#include "runtime/cpp/src/platform/clock.hpp"
#include "runtime/cpp/src/platform/files.hpp"

namespace rr {
namespace {

// Bytes of the character of UTF-8 that a text begins with; 0 when it begins with none.
std::size_t sequence_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  std::size_t length = 0;
  if (first >= 0xC2 && first <= 0xDF) length = 2;
  if (first >= 0xE0 && first <= 0xEF) length = 3;
  if (first >= 0xF0 && first <= 0xF4) length = 4;
  if (length == 0 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80) return 0;
  }
  const unsigned second = byte(1);
  const bool is_overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
  const bool is_beyond = (first == 0xED && second > 0x9F) || (first == 0xF4 && second > 0x8F);
  return is_overlong || is_beyond ? 0 : length;
}

// A string of JSON. A peer's text cannot end its line or steer a terminal; bytes that are no UTF-8
// become U+FFFD. Beyond `longest_text` bytes it is cut.
constexpr std::size_t longest_text = 1024;
void add_text(std::string& line, std::string_view text) {
  const bool is_cut = text.size() > longest_text;
  text = text.substr(0, longest_text);
  line += '"';
  while (!text.empty()) {
    const auto first = static_cast<unsigned char>(text.front());
    const std::size_t length = sequence_length(text);
    // C1 control characters are two bytes, of which the first is 0xC2.
    const bool is_control =
        first < 0x20 || first == 0x7F ||
        (length == 2 && first == 0xC2 && static_cast<unsigned char>(text[1]) < 0xA0);
    if (length == 0) {
      line += "\\ufffd";
    } else if (is_control) {
      std::array<char, 8> escape{};
      const unsigned code = length == 2 ? static_cast<unsigned char>(text[1]) : first;
      std::snprintf(escape.data(), escape.size(), "\\u%04x", code);
      line += escape.data();
    } else {
      if (first == '"' || first == '\\') line += '\\';
      line += text.substr(0, length);
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  if (is_cut) line += "...";
  line += '"';
}

void add_member(std::string& line, std::string_view name, std::string_view text) {
  if (text.empty()) return;
  line += ",\"";
  line += name;
  line += "\":";
  add_text(line, text);
}

std::string time_text(std::chrono::system_clock::time_point time) {
  const auto since = std::chrono::floor<std::chrono::microseconds>(time.time_since_epoch());
  const auto seconds = std::chrono::floor<std::chrono::seconds>(since);
  const std::tm parts = platform::utc(static_cast<std::time_t>(seconds.count()));
  std::array<char, 64> text{};
  const std::size_t size = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%S", &parts);
  std::snprintf(text.data() + size, text.size() - size, ".%06dZ",
                static_cast<int>((since - seconds).count()));
  return text.data();
}

std::string failure(const std::string& path, const char* what, const std::error_code& error) {
  return "cannot " + std::string(what) + " `" + path + "`: " + error.message();
}

}  // namespace

std::string_view audit_kind_name(AuditKind kind) {
  constexpr std::array<std::string_view, 8> names{"connect", "disconnect", "login",  "logout",
                                                  "lock",    "unlock",     "access", "ended"};
  return names.at(static_cast<std::size_t>(kind));
}

std::string AuditLog::line(const AuditEvent& event) {
  std::string line = "{\"time\":\"" + time_text(event.time) + "\"";
  add_member(line, "event", audit_kind_name(event.kind));
  add_member(line, "outcome", event.is_allowed ? "allowed" : "refused");
  add_member(line, "service", event.service);
  add_member(line, "path", event.path);
  add_member(line, "member", event.member);
  add_member(line, "operation", event.operation);
  add_member(line, "user", event.user);
  if (!event.node.is_any()) add_member(line, "node", event.node.text());
  add_member(line, "node_name", event.node_name);
  line += ",\"client\":" + std::to_string(event.client);
  add_member(line, "address", event.address);
  add_member(line, "certificate", event.certificate);
  add_member(line, "reason", event.reason);
  if (event.left_out != 0) line += ",\"left_out\":" + std::to_string(event.left_out);
  return line + "}\n";
}

/// The file that is written to. Guarded by a lock of its own, which no other is taken under.
class AuditLog::File {
 public:
  File(std::string path, Options options) : path_(std::move(path)), options_(options) { open(); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  void write(std::string_view line) {
    const MutexLock lock(mutex_);
    if (size_ != 0 && size_ + line.size() > options_.max_size) rotate();
    const auto bytes = std::as_bytes(std::span(line));
    const std::error_code error = platform::write_all(file_.get(), bytes);
    if (error) throw Error(ErrorCode::io_error, failure(path_, "write", error));
    size_ += line.size();
  }

 private:
  void open() RR_REQUIRES(mutex_) {
    std::error_code error;
    platform::OpenLog log = platform::open_log(path_, error);
    if (error) throw Error(ErrorCode::invalid_configuration, failure(path_, "open", error));
    if (log.is_foreign) {
      throw Error(ErrorCode::invalid_configuration,
                  "`" + path_ + "` is no regular file of this user");
    }
    file_ = std::move(log.file);
    size_ = log.size;
  }

  // What cannot be renamed grows on.
  void rotate() RR_REQUIRES(mutex_) {
    for (unsigned i = options_.kept_files; i > 1; --i) {
      platform::rename_file(path_ + "." + std::to_string(i - 1), path_ + "." + std::to_string(i));
    }
    const std::error_code error = options_.kept_files == 0
                                      ? platform::remove_file(path_)
                                      : platform::rename_file(path_, path_ + ".1");
    if (!error) open();
  }

  const std::string path_;
  const Options options_;
  Mutex mutex_;
  platform::File file_ RR_GUARDED_BY(mutex_);
  std::size_t size_ RR_GUARDED_BY(mutex_) = 0;
};

AuditLog::AuditLog(std::string path, Options options)
    : file_(std::make_shared<File>(std::move(path), options)) {}

void AuditLog::operator()(const AuditEvent& event) const { file_->write(line(event)); }

}  // namespace rr
