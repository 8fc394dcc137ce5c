// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "compiler/diagnostics/render.hpp"
#include "compiler/diagnostics/report.hpp"
#include "compiler/driver/discover_options.hpp"
#include "compiler/driver/live_options.hpp"
#include "compiler/driver/recording_options.hpp"
#include "compiler/syntax/read.hpp"

/// The command line of `robdef`: one table of commands, one of options, read by the parser and by
/// `--help` alike.
namespace robdef {

enum class Command {
  generate,
  check,
  describe,
  model,
  view,
  explain,
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
  connect,
  complete
};

/// What the user asked for. Which parts mean something depends on the command.
struct Options {
  Command command{};
  /// Definition files; for explain: codes and rules; for inspect and replay: recordings; for ca:
  /// what to do and with what; for what uses a running service: its URL, and members or a path.
  std::vector<std::string> inputs;
  /// Folders in which imports are looked for: those of `-I`, then those of the environment.
  ast::SearchPath search_path;
  std::string language;
  std::string output_folder = ".";
  std::string template_folder;  ///< empty: the templates of the backend
  std::string depfile;          ///< empty: none
  std::string depfile_target;   ///< empty: the outputs
  Format format = Format::text;
  std::vector<Code> silenced;  ///< warnings not to be reported
  bool is_strict = false;
  bool lists_outputs = false;
  bool lists_codes = false;
  bool is_json = false;
  RecordingOptions recording;
  DiscoverOptions discover;
  LiveOptions live;
  std::string authority_folder = ".";  ///< of `ca`
  std::optional<int> days;             ///< of `ca`; none: as usual
};

/// Text that answers the command line itself: help or the version.
struct Answer {
  std::string text;
};

/// Why the command line cannot be understood, in one or two lines.
struct UsageError {
  std::string text;
};

/// Understands the arguments behind the program's name. `import_variable` is the value of
/// ROBOTRACONTEUR_ROBDEF_PATH: folders separated by `:` or `;`.
std::variant<Options, Answer, UsageError> parse_options(std::span<const std::string> arguments,
                                                        std::string_view import_variable);

}  // namespace robdef
