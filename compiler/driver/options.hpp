// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <any>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "compiler/diagnostics/levels.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/diagnostics/report.hpp"
#include "compiler/docs/docs.hpp"
#include "compiler/driver/breaking_options.hpp"
#include "compiler/model/rename.hpp"
#include "compiler/syntax/read.hpp"

/// The command line of `robdef`: one table of commands, one of options, read by the parser and by
/// `--help` alike.
namespace robdef {

/// Those of the compiler up to `lsp`; the others are in cli/, which a compiler alone does not have.
enum class Command {
  generate,
  check,
  format,
  breaking,
  docs,
  describe,
  model,
  view,
  explain,
  lsp,
  inspect,
  record,
  replay,
  bridge,
  ca,
  discover,
  get,
  set,
  call,
  watch,
  top,
  connect,
  complete
};

struct CommandTable;

/// What the user asked for. Which parts mean something depends on the command.
struct Options {
  Command command{};
  /// Definition files, `-` for standard input; for explain: codes and rules; for inspect and
  /// replay: recordings; for breaking: the old and the new version; for ca: what to do and with
  /// what; for what uses a running service: its URL, and members or a path.
  std::vector<std::string> inputs;
  /// Folders in which imports are looked for: those of `-I`, then those of the environment.
  ast::SearchPath search_path;
  std::size_t own_import_folders = 0;  ///< those of `-I`
  std::vector<std::string> languages;  ///< generate, view: one at most
  std::string output_folder;           ///< empty: not given
  std::string template_folder;         ///< empty: the templates of the backend
  std::string plugin;                  ///< generate: a program, or one of the project file
  std::map<std::string, std::string> plugin_options;
  std::string config_file;  ///< empty: the one that is found
  bool ignores_config = false;
  std::vector<model::Rename> renames;
  std::string depfile;         ///< empty: none
  std::string depfile_target;  ///< empty: the outputs
  Format format = Format::text;
  Levels levels;  ///< of warnings
  bool is_strict = false;
  bool lists_outputs = false;
  bool lists_codes = false;
  bool is_json = false;
  docs::Form docs_form = docs::Form::html;
  bool checks_only = false;  ///< format: says what would change, and writes nothing
  BreakingOptions breaking;
  std::any more;  ///< what commands that are not the compiler's are told
  /// Of the program; set by parse_options().
  const CommandTable* table = nullptr;
};

/// Text that answers the command line itself: help or the version.
struct Answer {
  std::string text;
};

/// Why the command line cannot be understood, in one or two lines.
struct UsageError {
  std::string text;
};

/// Understands the arguments behind the name of a program with these commands. `import_variable` is
/// the value of ROBOTRACONTEUR_ROBDEF_PATH: folders separated by `:` or `;`.
std::variant<Options, Answer, UsageError> parse_options(std::span<const std::string> arguments,
                                                        std::string_view import_variable,
                                                        const CommandTable& table);

}  // namespace robdef
