// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <ostream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "compiler/diagnostics/report.hpp"
#include "compiler/diagnostics/source.hpp"
#include "compiler/model/model.hpp"
#include "compiler/output/file_set.hpp"

/// Backends that are programs of their own (docs/howto/plugins.md): definitions go in as JSON,
/// files and findings come out.
namespace robdef::plugin {

/// A plug-in that does not keep to the rules. The message names it.
class PluginError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Which program is run, and what it is told.
struct Plugin {
  /// A path, or a name without `/` that is looked for along PATH.
  std::string program;
  /// Keys with values, each key once, in the order of the keys.
  std::vector<std::pair<std::string, std::string>> options;
};

/// What the plug-in reads: the document, without blanks, and a line end.
std::string request_text(const Plugin& plugin, const model::Model& model, const Sources& sources);

/// Runs the plug-in over the model. Its findings are added to `report` (R1001, R1002), what it
/// writes to its standard error goes to `err`, line by line. No file of the result would lie
/// outside `folder`. Throws PluginError.
FileSet generate(const Plugin& plugin, const model::Model& model, const Sources& sources,
                 const std::filesystem::path& folder, Report& report, std::ostream& err);

}  // namespace robdef::plugin
