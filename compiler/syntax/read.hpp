// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/report.hpp"
#include "compiler/diagnostics/source.hpp"
#include "compiler/syntax/ast.hpp"

namespace robdef::ast {

/// The environment variable with further folders for imports.
inline constexpr const char* search_path_variable = "ROBOTRACONTEUR_ROBDEF_PATH";

/// Where imports are looked for, besides the folder of the file that imports.
struct SearchPath {
  std::vector<std::string> folders;  ///< first to last
};

/// The folders given by `-I`, then those of an environment variable's text, which are separated by
/// `:` or `;`. Empty ones are left out.
SearchPath make_search_path(std::vector<std::string> folders, std::string_view variable);

/// Reads the named files and everything they import, over any number of steps. An import is found
/// among the files loaded, else as `<service name>.robdef` in the folder of the importing file,
/// else along the path. One that is not found is left out; the model reports it, unless Import says
/// that it is reported (unreadable, or a file of another service). Reports R0509 (input not found),
/// R0510 (unreadable), R0511 (a service twice), R0512, and what parse does. A file that cannot be
/// opened is a source without text.
Program read(const std::vector<std::string>& inputs, const SearchPath& path, Sources& sources,
             Report& report);

/// A definition that is in memory.
struct NamedText {
  std::string name;  ///< for messages, for instance `example.types.robdef`
  std::string text;
  bool is_import = false;
};

/// As read, from memory: imports are found among the texts and nowhere else.
Program read_texts(std::vector<NamedText> texts, Sources& sources, Report& report);

}  // namespace robdef::ast
