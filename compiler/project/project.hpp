// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/levels.hpp"
#include "compiler/diagnostics/report.hpp"
#include "compiler/diagnostics/source.hpp"
#include "compiler/model/rename.hpp"

/// The project file, `robdef.toml`: what is read and what is made of it
/// (docs/reference/configuration.md).
namespace robdef::project {

/// What the file of a project is called.
inline constexpr std::string_view file_name = "robdef.toml";

/// What a project says about one language. Paths are seen from the current folder.
struct Language {
  std::string name;             ///< `cpp`
  std::string output_folder;    ///< empty: nothing is generated unless the command line says so
  std::string template_folder;  ///< empty: the templates of the backend
  std::vector<model::Rename> renames;
  Span span;  ///< of its table's name
};

/// `[plugin.NAME]`: generated like a language, by a program (docs/howto/plugins.md).
struct Plugin : Language {
  std::string program;  ///< never empty; a name without `/` is one along PATH
  std::map<std::string, std::string> options;
};

struct Project {
  std::string path;  ///< of the file
  bool has_inputs = false;
  std::vector<std::string> inputs;  ///< files, each once, in the order of the patterns
  std::vector<std::string> import_folders;
  bool is_strict = false;
  Levels levels;
  std::vector<Language> languages;  ///< in the order of the languages that are known

  std::vector<Plugin> plugins;  ///< in the order of the file

  /// nullptr when the file says nothing about it.
  [[nodiscard]] const Language* find(std::string_view language) const;
  /// The same for a plug-in.
  [[nodiscard]] const Plugin* find_plugin(std::string_view name) const;
};

/// The project file of the current folder, else of the nearest folder above it, as seen from the
/// current folder: `../robdef.toml`. Empty when there is none.
std::string find_file();

/// The same for another folder, whose path is absolute; so is what it gives.
std::string find_file(const std::string& folder);

/// Reads a project file, and looks for its inputs. `languages` are the names that tables may have.
/// Reports R0510 (unreadable) and R0801 to R0804.
Project read(const std::string& path, const std::vector<std::string_view>& languages,
             Sources& sources, Report& report);

}  // namespace robdef::project
