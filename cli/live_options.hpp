// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/tls_files.hpp"

namespace robdef {

/// What the commands that connect to a service are told besides its URL.
struct LiveOptions {
  std::string user;           ///< empty: no log-in
  std::string password_file;  ///< empty: the environment or a question
  std::optional<std::chrono::milliseconds> timeout;
  TlsFiles tls;  ///< also of `discover` and `bridge`

  // memories
  std::optional<std::vector<std::uint64_t>> position;  ///< none: the beginning
  std::optional<std::vector<std::uint64_t>> counts;    ///< none: up to the end

  std::optional<std::chrono::milliseconds> period;  ///< top: between two tables; none: 1 s

  // watch, top and generators
  std::optional<std::uint64_t> limit;                 ///< values; none: all
  std::optional<std::chrono::milliseconds> duration;  ///< none: until interrupted
};

}  // namespace robdef
