// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace robdef {

/// What another program has printed.
struct ChildOutput {
  int status = -1;  ///< exit status; -1 when a signal has ended it
  std::string out;
  std::string err;      ///< its first 4 KiB
  bool is_cut = false;  ///< it printed more than `limit` bytes, and was ended
};

/// Runs a program, found along PATH, with these arguments, without a shell and with an empty input,
/// and waits for its end. Throws std::system_error when it cannot be started.
ChildOutput run_child(const std::vector<std::string>& words, std::size_t limit);

}  // namespace robdef
