// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/driver/compile.hpp"
#include "compiler/driver/options.hpp"
#include "compiler/syntax/read.hpp"

/// The tables of the command line.
namespace robdef {

struct CommandRow {
  Command command{};
  std::string_view name;
  std::string_view arguments;    ///< as in the usage line
  std::string_view summary;      ///< one line, for the list of commands
  std::string_view description;  ///< paragraphs for `robdef COMMAND --help`, each line at most 78
};

/// Which commands an option belongs to.
struct CommandSet {
  unsigned bits = 0;

  constexpr CommandSet(std::initializer_list<Command> commands) {
    for (const Command command : commands) bits |= 1U << static_cast<unsigned>(command);
  }
  [[nodiscard]] constexpr bool contains(Command command) const {
    return (bits >> static_cast<unsigned>(command) & 1U) != 0;
  }
};

struct OptionRow {
  std::string_view name;        ///< `--lang`; empty where there is only a letter
  std::string_view short_name;  ///< `-I`; empty: none
  std::string_view value;       ///< name of the value in the help; empty for a switch
  CommandSet commands;
  std::string_view help;  ///< lines for the help, each at most 50
  /// Takes the value into the options. Returns what is wrong with it; empty when nothing is.
  std::string (*take)(Options& options, const std::string& value);

  /// How it is called in messages: the long name if there is one.
  [[nodiscard]] std::string_view title() const { return name.empty() ? short_name : name; }
};

/// The commands that read definitions.
inline constexpr CommandSet reading_definitions = {Command::generate, Command::check,
                                                   Command::docs,     Command::describe,
                                                   Command::model,    Command::view};

/// The commands of a program, and what those do that are not the compiler's.
struct CommandTable {
  std::vector<CommandRow> commands{};
  std::vector<OptionRow> options{};
  /// Commands that are for shells and not for people: in no list.
  std::vector<CommandRow> hidden{};

  // Null where there are no such commands.

  /// What is missing on a command line, or too much; empty when nothing is. Nothing for one of the
  /// compiler.
  std::optional<std::string> (*missing)(const Options& options) = nullptr;
  /// Does a command; nothing for one of the compiler.
  std::optional<ExitStatus> (*run)(const Options& options, std::ostream& out,
                                   std::ostream& err) = nullptr;
  /// Text after the options in the help of a command. Empty: the compiler's own.
  std::string_view (*notes)(Command command) = nullptr;
  /// Whether a version of definitions is sent or recorded, and not in files.
  bool (*is_sent)(const std::string& version) = nullptr;
  /// Its definitions. Throws VersionError.
  std::vector<ast::NamedText> (*read_sent)(const std::string& version, const Options& options,
                                           std::ostream& err) = nullptr;
};

/// The compiler's commands.
CommandTable compiler_commands();

/// `robdef --help`.
std::string general_help(const CommandTable& table);
/// `robdef COMMAND --help`.
std::string help_of(const CommandRow& command, const CommandTable& table);

}  // namespace robdef
