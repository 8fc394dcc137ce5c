// SPDX-License-Identifier: Apache-2.0
#include "compiler/driver/options.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "cli/authority_verbs.hpp"
#include "cli/live/commands.hpp"
#include "cli/live/table.hpp"
#include "compiler/diagnostics/spelling.hpp"
#include "compiler/driver/command_table.hpp"

namespace robdef {

namespace {

std::string in_quotes(std::string_view text) { return "`" + std::string(text) + "`"; }

std::string suggestion(std::string_view written, const std::vector<std::string_view>& candidates) {
  const std::string_view near = nearest(written, candidates);
  return near.empty() ? "" : "; did you mean " + in_quotes(near) + "?";
}

const CommandRow* find_command(std::string_view name) {
  for (const CommandRow& row : command_rows()) {
    if (row.name == name) return &row;
  }
  const CommandRow& hidden = live::completing_command();
  return hidden.name == name ? &hidden : nullptr;
}

// A value, not an option: options do not begin with digits.
bool is_negative_number(std::string_view argument) {
  return argument.size() > 1 && argument[0] == '-' && argument[1] >= '0' && argument[1] <= '9';
}

UsageError unknown_command(std::string_view name) {
  std::vector<std::string_view> names;
  for (const CommandRow& row : command_rows()) names.push_back(row.name);
  return {"unknown command " + in_quotes(name) + suggestion(name, names) +
          "\n`robdef --help` lists the commands"};
}

/// An argument taken apart: `--lang=cpp`, `--lang cpp`, `-I DIR`, `-IDIR`.
struct Written {
  std::string_view name;
  std::optional<std::string> value;
};

Written take_apart(std::string_view argument) {
  if (argument.starts_with("--")) {
    const std::size_t equals = argument.find('=');
    if (equals == std::string_view::npos) return {argument, std::nullopt};
    return {argument.substr(0, equals), std::string(argument.substr(equals + 1))};
  }
  if (argument.size() == 2) return {argument, std::nullopt};
  return {argument.substr(0, 2), std::string(argument.substr(2))};
}

/// Reads the arguments behind the name of a command.
class ArgumentReader {
 public:
  ArgumentReader(const CommandRow& command, std::span<const std::string> arguments)
      : command_(command), arguments_(arguments) {
    options_.command = command.command;
  }

  std::variant<Options, Answer, UsageError> read() {
    bool options_end = false;
    while (!arguments_.empty()) {
      const std::string& argument = arguments_.front();
      arguments_ = arguments_.subspan(1);
      if (options_end || argument.size() < 2 || argument.front() != '-' ||
          is_negative_number(argument)) {
        options_.inputs.push_back(argument);
      } else if (argument == "--") {
        options_end = true;
      } else if (argument == "--help" || argument == "-h") {
        return Answer{help_of(command_)};
      } else if (std::string complaint = take(argument); !complaint.empty()) {
        return usage_error(std::move(complaint));
      }
    }
    if (std::string complaint = missing(); !complaint.empty()) {
      return usage_error(std::move(complaint));
    }
    return std::move(options_);
  }

 private:
  [[nodiscard]] UsageError usage_error(std::string complaint) const {
    return {std::move(complaint) + "\n`robdef " + std::string(command_.name) +
            " --help` shows the options"};
  }

  std::string take(std::string_view argument) {
    Written written = take_apart(argument);
    const OptionRow* row = find(written.name);
    if (row == nullptr) return unknown(written.name);
    if (row->value.empty()) {
      if (written.value) return in_quotes(row->title()) + " takes no value";
      written.value = "";
    } else if (!written.value) {
      if (arguments_.empty()) {
        return in_quotes(written.name) + " needs a value: " + std::string(row->value);
      }
      written.value = arguments_.front();
      arguments_ = arguments_.subspan(1);
    }
    const std::string complaint = row->take(options_, *written.value);
    return complaint.empty() ? "" : in_quotes(written.name) + ": " + complaint;
  }

  [[nodiscard]] const OptionRow* find(std::string_view name) const {
    for (const OptionRow& row : option_rows()) {
      if (row.commands.contains(command_.command) && (row.name == name || row.short_name == name)) {
        return &row;
      }
    }
    return nullptr;
  }

  [[nodiscard]] std::string unknown(std::string_view name) const {
    std::vector<std::string_view> names = {"--help"};
    for (const OptionRow& row : option_rows()) {
      if (row.commands.contains(command_.command)) {
        names.push_back(row.name);
      } else if (row.name == name || row.short_name == name) {
        return "`robdef " + std::string(command_.name) + "` has no option " + in_quotes(name);
      }
    }
    return "unknown option " + in_quotes(name) + suggestion(name, names);
  }

  [[nodiscard]] std::string missing() const {
    if (options_.inputs.empty() && command_.command == Command::explain && !options_.lists_codes) {
      return "no code given";
    }
    if (command_.command == Command::record) return missing_to_record();
    if (command_.command == Command::bridge) return missing_to_bridge();
    if (command_.command == Command::breaking) return missing_to_compare();
    if (command_.command == Command::ca) return missing_for_authority(options_);
    if (command_.command == Command::discover) {
      return options_.inputs.empty() ? "" : "`robdef discover` takes no files";
    }
    if (command_.command == Command::lsp) {
      return options_.inputs.empty() ? "" : "`robdef lsp` takes no files; the editor names them";
    }
    if (command_.command >= Command::get ||
        (command_.command == Command::describe && !options_.inputs.empty() &&
         is_url(options_.inputs.front()))) {
      return live::missing(options_);
    }
    if (reading_definitions.contains(command_.command)) return missing_to_compile();
    if (options_.inputs.empty() && command_.command != Command::explain) return "no file given";
    if (command_.command == Command::replay) return missing_to_replay();
    if (!options_.inputs.empty() && options_.lists_codes) return "`--list` takes no codes";
    return "";
  }

  /// Inputs and languages may be in a project file: job.hpp asks for them.
  [[nodiscard]] std::string missing_to_compile() const {
    if (!options_.config_file.empty() && options_.ignores_config) {
      return "give either `--config` or `--no-config`";
    }
    if (!options_.depfile_target.empty() && options_.depfile.empty()) {
      return "`--depfile-target` needs `--depfile`";
    }
    return "";
  }

  [[nodiscard]] std::string missing_to_record() const {
    const RecordingOptions& wanted = options_.recording;
    if (!options_.inputs.empty()) return "`robdef record` takes no files; name one with `-o`";
    if (wanted.connect.empty()) return "`--connect` is missing";
    if (!wanted.port) return "`--listen` is missing";
    return wanted.output.empty() ? "`--output` is missing" : "";
  }

  [[nodiscard]] std::string missing_to_bridge() const {
    if (options_.inputs.empty()) return "no board given";
    return options_.recording.port ? "" : "`--listen` is missing";
  }

  [[nodiscard]] std::string missing_to_compare() const {
    if (options_.inputs.size() != 2) return "give two versions: the old and the new one";
    const bool has_url = std::any_of(options_.inputs.begin(), options_.inputs.end(), is_url);
    if (!has_url) return options_.live.user.empty() ? "" : "`--user` is for the URL of a service";
    return live::missing_to_connect(options_);
  }

  [[nodiscard]] std::string missing_to_replay() const {
    const RecordingOptions& wanted = options_.recording;
    if (options_.inputs.size() != 1) return "one file at a time can be played";
    if (wanted.connect.empty() == !wanted.port) return "give either `--connect` or `--listen`";
    return "";
  }

  const CommandRow& command_;
  std::span<const std::string> arguments_;
  Options options_;
};

}  // namespace

std::variant<Options, Answer, UsageError> parse_options(std::span<const std::string> arguments,
                                                        std::string_view import_variable) {
  if (arguments.empty()) return UsageError{"no command given\n`robdef --help` lists the commands"};
  const std::string& first = arguments.front();
  if (first == "--version") return Answer{"robdef " ROBDEF_VERSION "\n"};
  if (first == "--help" || first == "-h" || (first == "help" && arguments.size() == 1)) {
    return Answer{general_help()};
  }
  if (first == "help") {
    const CommandRow* topic = find_command(arguments[1]);
    if (topic == nullptr) return unknown_command(arguments[1]);
    return Answer{help_of(*topic)};
  }
  const CommandRow* command = find_command(first);
  if (command == nullptr) {
    return first.starts_with("-")
               ? UsageError{"the first argument is a command, not " + in_quotes(first) +
                            "\n`robdef --help` lists the commands"}
               : unknown_command(first);
  }
  auto result = ArgumentReader(*command, arguments.subspan(1)).read();
  if (auto* options = std::get_if<Options>(&result)) {
    options->own_import_folders = options->search_path.folders.size();
    options->search_path =
        ast::make_search_path(std::move(options->search_path.folders), import_variable);
  }
  return result;
}

}  // namespace robdef
