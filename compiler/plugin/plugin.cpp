// SPDX-License-Identifier: Apache-2.0
// The whole of it: model -> document -> program -> answer -> files.
#include "compiler/plugin/plugin.hpp"

#include "compiler/diagnostics/excerpt.hpp"
#include "compiler/plugin/answer.hpp"
#include "compiler/plugin/program.hpp"

namespace robdef::plugin {
namespace {

/// A finding without a place is about everything: it is shown at the first definition's name.
Span place_of_all(const model::Model& model) {
  for (const auto& definition : model.definitions()) {
    if (!definition->is_import) return definition->span;
  }
  return {};
}

/// An answer of a program that has not read everything may be right; a wrong one is so because of
/// that.
std::string how_much_was_read(const Printed& printed, std::size_t size) {
  if (printed.read == size) return "";
  return "; it closed its input after " + std::to_string(printed.read) + " of " +
         std::to_string(size) + " bytes";
}

}  // namespace

FileSet generate(const Plugin& plugin, const model::Model& model, const Sources& sources,
                 const std::filesystem::path& folder, Report& report, std::ostream& err) {
  const std::string name = "the plug-in `" + printable(plugin.program) + "`";
  const std::string request = request_text(plugin, model, sources);
  Printed printed;
  try {
    printed = run_program(plugin.program, request, {.output = largest_answer}, err);
  } catch (const PluginError& error) {
    throw PluginError(name + " " + error.what());
  }
  try {
    Answer answer = read_answer(printed.text, sources, folder);
    for (Finding& finding : answer.findings) {
      const Code code = finding.severity == Severity::error ? Code::R1001 : Code::R1002;
      const Span span = finding.at.value_or(place_of_all(model));
      report.add(code, span, std::move(finding.message)).note("said by " + name);
    }
    return std::move(answer.files);
  } catch (const PluginError& error) {
    throw PluginError(name + ": " + error.what() + how_much_was_read(printed, request.size()));
  }
}

}  // namespace robdef::plugin
