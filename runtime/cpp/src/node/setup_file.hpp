// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace rr {

/// One setting of a configuration file: the name of a flag without its prefix, and a value.
struct SetupLine {
  std::string name;
  std::string value;
  std::string place;  ///< `FILE:LINE`
};

/// Reads a file of lines `name = value`; lines that begin with `#` are comments. Throws rr::Error
/// (invalid_configuration), which names the place, for a file that cannot be read, is no regular
/// one or has more than 64 KiB, and for any other line.
std::vector<SetupLine> read_setup_file(const std::string& path);

}  // namespace rr
