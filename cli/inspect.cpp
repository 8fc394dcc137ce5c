// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <ostream>
#include <rr/error.hpp>
#include <rr/printable.hpp>
#include <rr/recording.hpp>

#include "cli/inspect_json.hpp"
#include "cli/inspect_summary.hpp"
#include "cli/inspect_text.hpp"
#include "cli/options.hpp"
#include "cli/recordings.hpp"
#include "cli/system/terminal.hpp"
#include "compiler/syntax/read.hpp"

namespace robdef {
namespace {

bool is_at_or_below(std::string_view path, std::string_view wanted) {
  if (!path.starts_with(wanted)) return false;
  return path.size() == wanted.size() || path[wanted.size()] == '.' || path[wanted.size()] == '[';
}

// Which records are looked at. An entry or a path that was asked for leaves messages only.
class Filter {
 public:
  explicit Filter(const RecordingOptions& wanted) : wanted_(wanted) {}

  [[nodiscard]] bool takes(const rr::Record& record) const {
    if (wanted_.connection && record.connection != *wanted_.connection) return false;
    const auto* message = std::get_if<rr::RecordedMessage>(&record.what);
    if (wanted_.entry_types.empty() && wanted_.path.empty()) return true;
    rr::MessageTree tree;
    if (message == nullptr || !rr::read_tree(message->bytes, tree)) return false;
    for (const rr::EntryTree& entry : tree.entries) {
      if (takes(entry)) return true;
    }
    return false;
  }

 private:
  [[nodiscard]] bool takes(const rr::EntryTree& entry) const {
    const bool is_type = wanted_.entry_types.empty() ||
                         wanted_.entry_types.contains(static_cast<std::uint16_t>(entry.type));
    return is_type && (wanted_.path.empty() || is_at_or_below(entry.service_path, wanted_.path));
  }

  const RecordingOptions& wanted_;
};

// What is to be said of the end of a file; empty when nothing is.
std::string complaint_about(const rr::Recording& recording) {
  const std::string at = std::to_string(recording.position());
  switch (recording.end()) {
    case rr::RecordingEnd::complete:
    case rr::RecordingEnd::open:
      return "";
    case rr::RecordingEnd::cut_off:
      return "cut off in the record at byte " + at;
    case rr::RecordingEnd::damaged:
      return "damaged: the record at byte " + at + " is not as it was written";
  }
  return "";
}

/// Standard input as a file: recordings are read back and forth, which a pipe is not.
class SpooledInput {
 public:
  SpooledInput() {
    path_ = system::make_temporary_file();
    if (path_.empty()) {
      throw rr::Error(rr::ErrorCode::io_error, "no room for a copy of standard input");
    }
    std::ofstream copy(path_, std::ios::binary);
    copy << std::cin.rdbuf();
  }
  SpooledInput(const SpooledInput&) = delete;
  SpooledInput& operator=(const SpooledInput&) = delete;
  ~SpooledInput() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

ExitStatus inspect_file(const std::string& path, const Options& options, std::ostream& out,
                        std::ostream& err) {
  std::optional<SpooledInput> spooled;
  if (ast::is_standard_input(path)) spooled.emplace();
  rr::Recording recording(spooled ? spooled->path() : path);
  const Filter filter(more(options).recording);
  Summary summary;
  for (rr::Record record; recording.next(record);) {
    if (!filter.takes(record)) continue;
    if (more(options).recording.is_summary) {
      summary.add(record);
    } else {
      out << (options.is_json ? rr::printable_json(json_of(record))
                              : rr::printable(line_of(record), rr::printable_whole))
          << '\n';
      if (!out) break;
    }
  }
  if (more(options).recording.is_summary) {
    out << (options.is_json ? rr::printable_json(summary.json())
                            : rr::printable(summary.text(recording.start()), rr::printable_whole,
                                            rr::LineBreaks::kept));
  }
  const std::string complaint = complaint_about(recording);
  if (complaint.empty()) return exit_fine;
  err << "robdef: " << ast::shown_name(path) << ": " << complaint << '\n';
  return exit_errors;
}

}  // namespace

ExitStatus inspect(const Options& options, std::ostream& out, std::ostream& err) {
  ExitStatus status = exit_fine;
  for (const std::string& path : options.inputs) {
    try {
      const ExitStatus each = inspect_file(path, options, out, err);
      if (each != exit_fine) status = each;
    } catch (const rr::Error& error) {
      err << "robdef: " << rr::printable(error.message()) << '\n';
      status = exit_errors;
    }
  }
  return status;
}

}  // namespace robdef
