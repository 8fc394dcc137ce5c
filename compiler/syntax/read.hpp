// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "compiler/diagnostics/report.hpp"
#include "compiler/diagnostics/source.hpp"
#include "compiler/syntax/ast.hpp"
#include "compiler/syntax/parse.hpp"

namespace robdef::ast {

/// The environment variable with further folders for imports.
inline constexpr const char* search_path_variable = "ROBOTRACONTEUR_ROBDEF_PATH";

/// Whether a path stands for standard input: `-`.
bool is_standard_input(std::string_view path);
/// What messages call it: the path, or `<stdin>`.
std::string shown_name(const std::string& path);
/// One spelling for each file, so that a file given twice is read once.
std::string identity_of(const std::string& path);

/// What is in a file, or why it cannot be read.
struct FileText {
  std::optional<std::string> text;
  std::string failure;      ///< in words, with the reason that the system gives
  bool is_missing = false;  ///< there is none of that name
};

/// Reads a file, or standard input, up to 64 MiB.
FileText read_file(const std::string& path);

/// Where imports are looked for, besides the folder of the file that imports.
struct SearchPath {
  std::vector<std::string> folders;  ///< first to last
};

/// The folders given by `-I`, then those of an environment variable's text, which are separated by
/// any of the letters; a `:` in the name of a folder that is there does not separate. Empty ones
/// are left out.
SearchPath make_search_path(std::vector<std::string> folders, std::string_view variable,
                            std::string_view separators = ":;");

/// Where the definition of a service may be, the first place that exists counts: `<service>.robdef`
/// in the folder of the importing file, then in those of the path.
std::vector<std::string> import_places(const std::string& service, const std::string& importing,
                                       const SearchPath& path);

/// Reads the named files, `-` for standard input, and everything they import, over any number of
/// steps. An import is found among the files loaded, else as `<service name>.robdef` in the folder
/// of the importing file, else along the path. One that is not found is left out; the model reports
/// it, unless Import says that it is reported (unreadable, or a file of another service). Reports
/// R0509 (input not found), R0510 (unreadable), R0511 (a service twice), R0512, and what parse
/// does. A file that cannot be opened is a source without text.
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

/// Finds the definition of a service that a text imports; nothing when there is none. `importing`
/// is the name of that text.
using FindImport = std::function<std::optional<NamedText>(const std::string& service,
                                                          const std::string& importing)>;

/// What was read of earlier versions of texts, by their names.
using EarlierFiles = std::unordered_map<std::string, EarlierFile>;

/// The same; imports that are not among the texts are those that `find` gives, over any number of
/// steps. Reports R0512 as read() does. What is among `earlier` is used up, and only what has
/// changed is parsed.
Program read_texts(std::vector<NamedText> texts, const FindImport& find, Sources& sources,
                   Report& report, EarlierFiles earlier = {});

}  // namespace robdef::ast
