// SPDX-License-Identifier: Apache-2.0
#include "compiler/driver/options.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "compiler/diagnostics/spelling.hpp"
#include "compiler/driver/command_table.hpp"
#include "compiler/system/conventions.hpp"

namespace robdef {

namespace {

std::string in_quotes(std::string_view text) { return "`" + std::string(text) + "`"; }

std::string suggestion(std::string_view written, const std::vector<std::string_view>& candidates) {
  const std::string_view near = nearest(written, candidates);
  return near.empty() ? "" : "; did you mean " + in_quotes(near) + "?";
}

const CommandRow* find_command(const CommandTable& table, std::string_view name) {
  for (const std::vector<CommandRow>* rows : {&table.commands, &table.hidden}) {
    const auto found = std::ranges::find(*rows, name, &CommandRow::name);
    if (found != rows->end()) return &*found;
  }
  return nullptr;
}

// A value, not an option: options do not begin with digits.
bool is_negative_number(std::string_view argument) {
  return argument.size() > 1 && argument[0] == '-' && argument[1] >= '0' && argument[1] <= '9';
}

UsageError unknown_command(const CommandTable& table, std::string_view name) {
  std::vector<std::string_view> names;
  for (const CommandRow& row : table.commands) names.push_back(row.name);
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
  ArgumentReader(const CommandTable& table, const CommandRow& command,
                 std::span<const std::string> arguments)
      : table_(table), command_(command), arguments_(arguments) {
    options_.command = command.command;
    options_.table = &table;
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
        return Answer{help_of(command_, table_)};
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
    for (const OptionRow& row : table_.options) {
      if (row.commands.contains(command_.command) && (row.name == name || row.short_name == name)) {
        return &row;
      }
    }
    return nullptr;
  }

  [[nodiscard]] std::string unknown(std::string_view name) const {
    std::vector<std::string_view> names = {"--help"};
    for (const OptionRow& row : table_.options) {
      if (row.commands.contains(command_.command)) {
        names.push_back(row.name);
      } else if (row.name == name || row.short_name == name) {
        return "`robdef " + std::string(command_.name) + "` has no option " + in_quotes(name);
      }
    }
    return "unknown option " + in_quotes(name) + suggestion(name, names);
  }

  [[nodiscard]] std::string missing() const {
    if (table_.missing != nullptr) {
      if (const auto complaint = table_.missing(options_)) return *complaint;
    }
    switch (command_.command) {
      case Command::explain:
        if (options_.inputs.empty()) return options_.lists_codes ? "" : "no code given";
        return options_.lists_codes ? "`--list` takes no codes" : "";
      case Command::breaking:
        return options_.inputs.size() == 2 ? "" : "give two versions: the old and the new one";
      case Command::lsp:
        return options_.inputs.empty() ? "" : "`robdef lsp` takes no files; the editor names them";
      case Command::format:
        return options_.inputs.empty() ? "no file given" : "";
      default:
        return missing_to_compile();
    }
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

  const CommandTable& table_;
  const CommandRow& command_;
  std::span<const std::string> arguments_;
  Options options_;
};

}  // namespace

std::variant<Options, Answer, UsageError> parse_options(std::span<const std::string> arguments,
                                                        std::string_view import_variable,
                                                        const CommandTable& table) {
  if (arguments.empty()) return UsageError{"no command given\n`robdef --help` lists the commands"};
  const std::string& first = arguments.front();
  if (first == "--version") return Answer{"robdef " ROBDEF_VERSION "\n"};
  if (first == "--help" || first == "-h" || (first == "help" && arguments.size() == 1)) {
    return Answer{general_help(table)};
  }
  if (first == "help") {
    const CommandRow* topic = find_command(table, arguments[1]);
    if (topic == nullptr) return unknown_command(table, arguments[1]);
    return Answer{help_of(*topic, table)};
  }
  const CommandRow* command = find_command(table, first);
  if (command == nullptr) {
    return first.starts_with("-")
               ? UsageError{"the first argument is a command, not " + in_quotes(first) +
                            "\n`robdef --help` lists the commands"}
               : unknown_command(table, first);
  }
  auto result = ArgumentReader(table, *command, arguments.subspan(1)).read();
  if (auto* options = std::get_if<Options>(&result)) {
    options->own_import_folders = options->search_path.folders.size();
    options->search_path = ast::make_search_path(std::move(options->search_path.folders),
                                                 import_variable, system::list_separators());
  }
  return result;
}

}  // namespace robdef
