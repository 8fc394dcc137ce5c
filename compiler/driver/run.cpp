// SPDX-License-Identifier: Apache-2.0
#include "compiler/driver/run.hpp"

#include <cstdlib>
#include <exception>
#include <iostream>
#include <optional>
#include <ostream>
#include <variant>
#include <vector>

#include "compiler/driver/breaking.hpp"
#include "compiler/driver/explain.hpp"
#include "compiler/driver/format.hpp"
#include "compiler/driver/lsp.hpp"
#include "compiler/syntax/read.hpp"
#include "compiler/system/conventions.hpp"

namespace robdef {

namespace {

ExitStatus explain(const Options& options, std::ostream& out, std::ostream& err) {
  std::vector<const CodeEntry*> entries;
  if (options.lists_codes) {
    for (const CodeEntry& entry : code_entries()) entries.push_back(&entry);
  } else {
    std::string unknown;
    entries = find_entries(options.inputs, unknown);
    if (!unknown.empty()) {
      err << "robdef: there is no code, rule or group `" << unknown
          << "`\n`robdef explain --list` shows all\n";
      return exit_usage;
    }
  }
  out << (options.is_json       ? entry_json(entries)
          : options.lists_codes ? entry_list(entries) + group_list()
                                : entry_text(entries));
  return exit_fine;
}

ExitStatus answer(std::span<const std::string> arguments, std::string_view import_variable,
                  const CommandTable& table, std::ostream& out, std::ostream& err) {
  const auto parsed = parse_options(arguments, import_variable, table);
  if (const auto* text = std::get_if<Answer>(&parsed)) {
    out << text->text;
    return exit_fine;
  }
  if (const auto* error = std::get_if<UsageError>(&parsed)) {
    err << "robdef: " << error->text << '\n';
    return exit_usage;
  }
  const auto& options = std::get<Options>(parsed);
  if (table.run != nullptr) {
    if (const std::optional<ExitStatus> status = table.run(options, out, err)) return *status;
  }
  switch (options.command) {
    case Command::explain:
      return explain(options, out, err);
    case Command::format:
      return format_files(options, out, err);
    case Command::breaking:
      return breaking_changes(options, out, err);
    case Command::lsp:
      return serve_editor(options, out);
    default:
      return compile(options, out, err);
  }
}

}  // namespace

ExitStatus run(std::span<const std::string> arguments, std::string_view import_variable,
               const CommandTable& table, std::ostream& out, std::ostream& err) {
  const ExitStatus status = answer(arguments, import_variable, table, out, err);
  if (out.flush()) return status;
  err << "robdef: standard output cannot be written\n";
  return status == exit_fine ? exit_errors : status;
}

ExitStatus guard(const std::function<ExitStatus()>& work, std::ostream& err) {
  try {
    return work();
  } catch (const std::exception& fault) {
    err << "robdef: this is a fault of robdef, not of your definition: " << fault.what()
        << "\nPlease report it, with the definition and the command line.\n";
  } catch (...) {
    err << "robdef: this is a fault of robdef, not of your definition: something unknown was "
           "thrown\nPlease report it, with the definition and the command line.\n";
  }
  return exit_fault;
}

int run_main(int count, char** words, const CommandTable& table) {
  system::prepare_streams();
  const std::vector<std::string> arguments(words + 1, words + count);
  const char* const variable = std::getenv(ast::search_path_variable);
  return guard(
      [&] {
        return run(arguments, variable == nullptr ? "" : variable, table, std::cout, std::cerr);
      },
      std::cerr);
}

}  // namespace robdef
