// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace robdef {

/// What `inspect`, `record` and `replay` are told.
struct RecordingOptions {
  // inspect
  std::set<std::uint16_t> entry_types;      ///< empty: all
  std::string path;                         ///< of a service or an object, with all below it
  std::optional<std::uint32_t> connection;  ///< none: all
  bool is_summary = false;
  bool is_page = false;  ///< the inspector instead of a recording

  // record and replay
  std::string output;                 ///< file to write
  std::string connect;                ///< HOST:PORT, or a URL
  std::optional<std::uint16_t> port;  ///< of --listen
  bool listens_everywhere = false;
  bool drops = false;
  bool keeps_credentials = false;
  bool is_fast = false;
  double tolerance = 0;              ///< replay: of floating-point numbers
  std::vector<std::string> ignored;  ///< replay: members and objects that are not compared
};

/// Who can connect to a command that listens, and how that is changed: a line for standard error.
inline const char* place_line(const RecordingOptions& options) {
  return options.listens_everywhere
             ? "robdef: other machines can connect"
             : "robdef: only this machine can connect; --everywhere lets others in";
}

}  // namespace robdef
