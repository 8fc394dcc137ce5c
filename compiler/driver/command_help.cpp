// SPDX-License-Identifier: Apache-2.0
// What --help prints of the tables.
#include <utility>

#include "compiler/backends/backend.hpp"
#include "compiler/driver/command_table.hpp"

namespace robdef {
namespace {

/// `text` in a column that begins behind `indent` blanks; the first line stands there already.
std::string hanging(std::string_view text, std::size_t indent) {
  std::string lines;
  for (const char letter : text) {
    lines += letter;
    if (letter == '\n') lines.append(indent, ' ');
  }
  return lines + "\n";
}

std::string padded(std::string text, std::size_t width) {
  if (text.size() < width) text.resize(width, ' ');
  return text;
}

std::string option_line(std::string_view short_name, std::string_view name, std::string_view value,
                        std::string_view help) {
  constexpr std::size_t column = 28;
  std::string left = short_name.empty() ? "      " : "  " + std::string(short_name) + ", ";
  left += name;
  if (!value.empty()) left += " " + std::string(value);
  if (left.size() > column - 2) left += "\n" + std::string(column, ' ');
  return padded(std::move(left), column) + hanging(help, column);
}

std::string languages() {
  std::string text = "\nLanguages:\n";
  for (const Backend* backend : backends()) {
    text +=
        "  " + padded(std::string(backend->name()), 12) + std::string(backend->summary()) + "\n";
  }
  return text;
}

constexpr std::string_view environment_and_exit =
    "\nEnvironment:\n"
    "  ROBOTRACONTEUR_ROBDEF_PATH  folders searched for imports after those of -I,\n"
    "                              separated by : or ;\n"
    "\nExit status: 0 fine, 1 errors found, 2 used wrongly, 3 a fault of robdef itself.\n";

constexpr std::string_view breaking_exit =
    "\nEnvironment:\n"
    "  ROBOTRACONTEUR_ROBDEF_PATH  folders searched for imports after those of -I,\n"
    "                              separated by : or ;\n"
    "\nExit status: 0 nothing breaks, 1 something does, 2 used wrongly, or a version\n"
    "cannot be read, 3 a fault of robdef itself.\n";

}  // namespace

std::string general_help(const CommandTable& table) {
  std::string text =
      "usage: robdef COMMAND [OPTION...] FILE...\n"
      "\n"
      "Compiles service definitions (.robdef), the language of Robot Raconteur, into\n"
      "clients and services.\n"
      "\n"
      "Commands:\n";
  for (const CommandRow& row : table.commands) {
    text += "  " + padded(std::string(row.name), 12) + std::string(row.summary) + "\n";
  }
  text +=
      "\n"
      "  robdef COMMAND --help       the options of a command\n"
      "  robdef --version            the version of this program\n"
      "\n"
      "Examples:\n"
      "  robdef check experimental.mount.robdef\n"
      "  robdef generate --lang cpp -o generated -I shared experimental.mount.robdef\n"
      "  robdef explain R0203\n";
  text += languages();
  text += environment_and_exit;
  return text;
}

std::string help_of(const CommandRow& command, const CommandTable& table) {
  std::string text = "usage: robdef " + std::string(command.name) + " " +
                     std::string(command.arguments) + "\n\n" + std::string(command.description) +
                     "\nOptions:\n";
  bool has_language = false;
  for (const OptionRow& row : table.options) {
    if (!row.commands.contains(command.command)) continue;
    text += option_line(row.short_name, row.name, row.value, row.help);
    has_language = has_language || row.name == "--lang";
  }
  text += option_line("-h", "--help", "", "print this");
  if (has_language) text += languages();
  const std::string_view notes =
      table.notes == nullptr ? std::string_view() : table.notes(command.command);
  if (!notes.empty()) {
    text += notes;
  } else if (reading_definitions.contains(command.command)) {
    text += environment_and_exit;
  } else if (command.command == Command::breaking) {
    text += breaking_exit;
  } else if (command.command == Command::explain) {
    text += "\nExit status: 0 fine, 2 no such code.\n";
  } else {
    text += "\nExit status: 0 fine, 1 errors, 2 used wrongly, 3 a fault of robdef itself.\n";
  }
  return text;
}

}  // namespace robdef
