// SPDX-License-Identifier: Apache-2.0
#include "compiler/driver/compile.hpp"

#include <algorithm>
#include <filesystem>
#include <ostream>
#include <string>
#include <utility>

#include "compiler/backends/backend.hpp"
#include "compiler/driver/depfile.hpp"
#include "compiler/model/check.hpp"
#include "compiler/model/describe.hpp"
#include "compiler/model/dump.hpp"
#include "compiler/model/evaluate.hpp"
#include "compiler/model/layout.hpp"
#include "compiler/model/resolve.hpp"
#include "compiler/output/template.hpp"
#include "compiler/syntax/read.hpp"

namespace robdef {

namespace {

/// What a command makes of a model without errors: text for standard output, or files.
struct Product {
  std::string text;
  FileSet files;
};

std::string outlines(const model::Model& model) {
  std::string text;
  for (const auto& definition : model.definitions()) {
    if (definition->is_import) continue;
    if (!text.empty()) text += '\n';
    text += model::describe(*definition);
  }
  return text;
}

Product make_product(const Options& options, const model::Model& model, const Sources& sources,
                     Report& report) {
  switch (options.command) {
    case Command::generate:
      return {"", find_backend(options.language)
                      ->generate(model, {.template_folder = options.template_folder}, report)};
    case Command::describe:
      return {outlines(model), {}};
    case Command::model:
      return {model::dump(model, sources), {}};
    case Command::view:
      return {find_backend(options.language)->view(model, report), {}};
    case Command::check:
    case Command::explain:
    case Command::inspect:
    case Command::record:
    case Command::replay:
    case Command::bridge:
    case Command::ca:
    case Command::discover:
    case Command::get:
    case Command::set:
    case Command::call:
    case Command::watch:
    case Command::connect:
    case Command::complete:
      break;
  }
  return {};
}

std::string count_of(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

void print_findings(const Report& report, const Sources& sources, const Options& options,
                    std::ostream& out, std::ostream& err) {
  const bool prints_product = options.lists_outputs || (options.command != Command::check &&
                                                        options.command != Command::generate);
  std::ostream& target = options.format == Format::json && !prints_product ? out : err;
  target << render(report, sources, options.format);
  if (options.format != Format::text) return;
  // As shown: one that was found twice counts once.
  const auto shown = report.sorted();
  const auto errors = static_cast<std::size_t>(std::count_if(
      shown.begin(), shown.end(),
      [](const Diagnostic* diagnostic) { return diagnostic->severity() == Severity::error; }));
  const std::size_t warnings = shown.size() - errors;
  std::string summary = errors == 0 ? "" : count_of(errors, "error");
  if (warnings != 0) summary += (summary.empty() ? "" : ", ") + count_of(warnings, "warning");
  if (!summary.empty()) err << '\n' << summary << '\n';
}

std::string below(const std::string& folder, const std::string& path) {
  return folder == "." ? path : (std::filesystem::path(folder) / path).generic_string();
}

std::vector<std::string> output_paths(const FileSet& files, const std::string& folder) {
  std::vector<std::string> paths;
  for (const auto& [path, content] : files.files()) paths.push_back(below(folder, path));
  return paths;
}

/// Everything whose change may change the outputs: the definitions, and templates from outside.
std::vector<std::string> input_paths(const Sources& sources, const std::string& template_folder) {
  std::vector<std::string> paths;
  paths.reserve(sources.size());
  for (std::uint32_t index = 0; index < sources.size(); ++index) {
    paths.push_back(sources[SourceId{index}].name());
  }
  if (template_folder.empty()) return paths;
  const auto first_template = static_cast<std::ptrdiff_t>(paths.size());
  for (const auto& entry : std::filesystem::recursive_directory_iterator(template_folder)) {
    if (entry.is_regular_file()) paths.push_back(entry.path().generic_string());
  }
  std::sort(paths.begin() + first_template, paths.end());
  return paths;
}

/// Why not everything could be written; empty when it was.
std::string write_files(const FileSet& files, const Options& options, const Sources& sources) {
  std::string failure = files.write(options.output_folder).failure;
  if (!failure.empty() || options.depfile.empty()) return failure;
  const std::filesystem::path path = options.depfile;
  FileSet depfile;
  depfile.add(
      path.filename().generic_string(),
      depfile_text(options.depfile_target.empty() ? output_paths(files, options.output_folder)
                                                  : std::vector{options.depfile_target},
                   input_paths(sources, options.template_folder)));
  return depfile.write(path.has_parent_path() ? path.parent_path() : ".").failure;
}

ExitStatus deliver(const Product& product, const Options& options, const Sources& sources,
                   std::ostream& out, std::ostream& err) {
  out << product.text;
  if (options.lists_outputs) {
    for (const std::string& path : output_paths(product.files, options.output_folder)) {
      out << path << '\n';
    }
  } else if (options.command == Command::generate) {
    const std::string failure = write_files(product.files, options, sources);
    if (!failure.empty()) {
      err << "robdef: " << failure << '\n';
      return exit_errors;
    }
    if (options.format == Format::text) {
      for (const std::string& note : product.files.notes()) err << note << '\n';
    }
  }
  return exit_fine;
}

ExitStatus run_passes(const Options& options, std::ostream& out, std::ostream& err) {
  Sources sources;
  Report report;
  for (const Code code : options.silenced) report.silence(code);

  const ast::Program program = ast::read(options.inputs, options.search_path, sources, report);
  model::Model model = model::resolve(program, sources, report);
  model::evaluate(model, report);
  model::lay_out(model, report);
  model::check(model, report);
  if (options.is_strict) model::check_strictly(model, report);

  const Product product =
      report.has_errors() ? Product{} : make_product(options, model, sources, report);
  print_findings(report, sources, options, out, err);
  return report.has_errors() ? exit_errors : deliver(product, options, sources, out, err);
}

}  // namespace

ExitStatus compile(const Options& options, std::ostream& out, std::ostream& err) {
  try {
    return run_passes(options, out, err);
  } catch (const TemplateError& error) {
    // A fault in our own templates is ours and goes on.
    if (options.template_folder.empty()) throw;
    err << "robdef: " << error.what() << '\n';
    return exit_errors;
  }
}

}  // namespace robdef
