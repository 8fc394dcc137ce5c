// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>
#include <optional>
#include <string>

#include "compiler/diagnostics/source.hpp"
#include "compiler/driver/options.hpp"
#include "compiler/model/model.hpp"

namespace robdef {

/// One of the two versions that `robdef breaking` compares.
struct Version {
  std::string name;  ///< as messages call it
  model::Model model;
  /// There may be definitions that are not here: of a running service, or of a recording.
  bool is_partial = false;
  bool is_in_files = false;  ///< the names of its sources are paths
};

/// Reads a version, and everything that it imports: a file, `-` for standard input, or a folder
/// with all `.robdef` files in it and below; a git revision and a path in it, `HEAD~1:definitions`;
/// a recording of messages; or the URL of a running service. What there is of that name in the file
/// system comes first. Says on `err` what is wrong, and gives nothing then.
std::optional<Version> read_version(const std::string& what, const Options& options,
                                    Sources& sources, std::ostream& err);

}  // namespace robdef
