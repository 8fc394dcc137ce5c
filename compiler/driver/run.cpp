// SPDX-License-Identifier: Apache-2.0
#include "compiler/driver/run.hpp"

#include <exception>
#include <ostream>
#include <variant>
#include <vector>

#include "cli/authority.hpp"
#include "cli/discover.hpp"
#include "cli/live/commands.hpp"
#include "cli/recordings.hpp"
#include "compiler/driver/breaking.hpp"
#include "compiler/driver/explain.hpp"
#include "compiler/driver/format.hpp"
#include "compiler/driver/lsp.hpp"

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
                  std::ostream& out, std::ostream& err) {
  const auto parsed = parse_options(arguments, import_variable);
  if (const auto* text = std::get_if<Answer>(&parsed)) {
    out << text->text;
    return exit_fine;
  }
  if (const auto* error = std::get_if<UsageError>(&parsed)) {
    err << "robdef: " << error->text << '\n';
    return exit_usage;
  }
  const auto& options = std::get<Options>(parsed);
  switch (options.command) {
    case Command::explain:
      return explain(options, out, err);
    case Command::format:
      return format_files(options, out, err);
    case Command::breaking:
      return breaking_changes(options, out, err);
    case Command::inspect:
      return inspect(options, out, err);
    case Command::record:
      return record(options, out, err);
    case Command::replay:
      return replay(options, out, err);
    case Command::bridge:
      return bridge(options, out, err);
    case Command::ca:
      return run_authority(options, out, err);
    case Command::lsp:
      return serve_editor(options, out);
    case Command::discover:
      return discover(options, out, err);
    case Command::get:
    case Command::set:
    case Command::call:
    case Command::watch:
    case Command::connect:
    case Command::complete:
      return run_live(options, out, err);
    case Command::describe:
      if (!options.inputs.empty() && is_url(options.inputs.front())) {
        return run_live(options, out, err);
      }
      return compile(options, out, err);
    default:
      return compile(options, out, err);
  }
}

}  // namespace

ExitStatus run(std::span<const std::string> arguments, std::string_view import_variable,
               std::ostream& out, std::ostream& err) {
  const ExitStatus status = answer(arguments, import_variable, out, err);
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

}  // namespace robdef
