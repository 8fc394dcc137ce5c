// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>

namespace robdef {

/// What `inspect`, `record` and `replay` are told.
struct RecordingOptions {
  // inspect
  std::set<std::uint16_t> entry_types;      ///< empty: all
  std::string path;                         ///< of a service or an object, with all below it
  std::optional<std::uint32_t> connection;  ///< none: all
  bool is_summary = false;

  // record and replay
  std::string output;                 ///< file to write
  std::string connect;                ///< HOST:PORT, or a URL
  std::optional<std::uint16_t> port;  ///< of --listen
  bool listens_everywhere = false;
  bool drops = false;
  bool is_fast = false;
};

}  // namespace robdef
