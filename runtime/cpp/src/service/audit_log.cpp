// SPDX-License-Identifier: Apache-2.0
// Events as lines of JSON in a file.
#include <array>
#include <utility>

#include "rr/audit.hpp"
#include "runtime/cpp/src/channel/rotating_file.hpp"
#include "runtime/cpp/src/codec/json_text.hpp"
#include "runtime/cpp/src/platform/clock.hpp"

namespace rr {
namespace {

constexpr std::size_t longest_text = 1024;

void add_member(std::string& line, std::string_view name, std::string_view text) {
  if (text.empty()) return;
  line += ",\"";
  line += name;
  line += "\":";
  codec::add_json_text(line, text, longest_text);
}

}  // namespace

std::string_view audit_kind_name(AuditKind kind) {
  constexpr std::array<std::string_view, 8> names{"connect", "disconnect", "login",  "logout",
                                                  "lock",    "unlock",     "access", "ended"};
  return names.at(static_cast<std::size_t>(kind));
}

std::string AuditLog::line(const AuditEvent& event) {
  std::string line = "{\"time\":\"" + platform::utc_text(event.time, 6) + "\"";
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

/// The file that is written to.
class AuditLog::File {
 public:
  File(std::string path, const Options& options)
      : file_(std::move(path), options.max_size, options.kept_files) {}
  void write(std::string_view line) { file_.write(line); }

 private:
  channel::RotatingFile file_;
};

AuditLog::AuditLog(std::string path, Options options)
    : file_(std::make_shared<File>(std::move(path), options)) {}

void AuditLog::operator()(const AuditEvent& event) const { file_->write(line(event)); }

}  // namespace rr
