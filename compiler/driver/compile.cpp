// SPDX-License-Identifier: Apache-2.0
#include "compiler/driver/compile.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <ostream>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "compiler/backends/backend.hpp"
#include "compiler/docs/docs.hpp"
#include "compiler/driver/command_table.hpp"
#include "compiler/driver/depfile.hpp"
#include "compiler/driver/job.hpp"
#include "compiler/model/check.hpp"
#include "compiler/model/describe.hpp"
#include "compiler/model/dump.hpp"
#include "compiler/model/evaluate.hpp"
#include "compiler/model/layout.hpp"
#include "compiler/model/rename.hpp"
#include "compiler/model/resolve.hpp"
#include "compiler/output/manifest.hpp"
#include "compiler/output/pending_files.hpp"
#include "compiler/output/template.hpp"
#include "compiler/project/project.hpp"
#include "compiler/syntax/read.hpp"

namespace robdef {

namespace {

/// A fault in a template that the user gave.
class UserTemplateError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

std::string_view command_name(const Options& options) {
  const auto row =
      std::ranges::find(options.table->commands, options.command, &CommandRow::command);
  return row->name;
}

std::string outlines(const model::Model& model) {
  std::string text;
  for (const auto& definition : model.definitions()) {
    if (definition->is_import) continue;
    if (!text.empty()) text += '\n';
    text += model::describe(*definition);
  }
  return text;
}

std::string count_of(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

bool writes_files(const Options& options) {
  return options.command == Command::generate || options.command == Command::docs;
}

void print_findings(const Report& report, const Sources& sources, const Options& options,
                    std::ostream& out, std::ostream& err) {
  const bool prints_product =
      options.lists_outputs || (options.command != Command::check && !writes_files(options));
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

/// What is made for one target.
struct Output {
  const Target* target = nullptr;
  FileSet files;
};

std::vector<std::string> output_paths(const std::vector<Output>& outputs) {
  std::vector<std::string> paths;
  for (const Output& output : outputs) {
    for (const auto& [path, content] : output.files.files()) {
      paths.push_back(below(output.target->folder, path));
    }
  }
  return paths;
}

/// Everything whose change may change the outputs: the project file, the definitions, and templates
/// from outside.
std::vector<std::string> input_paths(const Sources& sources, const std::vector<Target>& targets) {
  std::vector<std::string> paths;
  paths.reserve(sources.size());
  for (std::uint32_t index = 0; index < sources.size(); ++index) {
    const std::string& name = sources[SourceId{index}].name();
    if (name != ast::shown_name("-")) paths.push_back(name);
  }
  std::set<std::string> templates;  // and plug-ins
  for (const Target& target : targets) {
    if (target.plugin && target.plugin->program.find('/') != std::string::npos) {
      templates.insert(target.plugin->program);
    }
    if (target.template_folder.empty()) continue;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(target.template_folder)) {
      if (entry.is_regular_file()) templates.insert(entry.path().generic_string());
    }
  }
  paths.insert(paths.end(), templates.begin(), templates.end());
  return paths;
}

/// Reads the project file, runs all passes over the definitions, and delivers what the command asks
/// for.
class Run {
 public:
  Run(const Options& options, std::ostream& out, std::ostream& err)
      : options_(options), out_(out), err_(err) {}

  ExitStatus run() {
    const std::optional<project::Project> project = read_project();
    if (report_.has_errors()) return end();
    const project::Project* const known = project ? &*project : nullptr;
    std::string complaint;
    job_ = make_job(options_, known, complaint);
    if (!complaint.empty()) {
      err_ << "robdef: " << complaint << "\n`robdef " << command_name(options_)
           << " --help` shows the options\n";
      return exit_usage;
    }
    std::vector<const Levels*> levels{&options_.levels};
    if (known != nullptr) levels.push_back(&known->levels);
    set_levels(report_, levels);
    return compile();
  }

 private:
  /// What a former run has made, and this one has not.
  struct Stale {
    const Output* output = nullptr;
    std::string path;
    bool is_edited = false;
  };

  std::optional<project::Project> read_project() {
    if (options_.ignores_config) return std::nullopt;
    const std::string path =
        options_.config_file.empty() ? project::find_file() : options_.config_file;
    if (path.empty()) return std::nullopt;
    std::vector<std::string_view> languages;
    for (const Backend* backend : backends()) languages.push_back(backend->name());
    return project::read(path, languages, sources_, report_);
  }

  ExitStatus compile() {
    const ast::Program program = ast::read(job_.inputs, job_.search_path, sources_, report_);
    model_ = model::resolve(program, sources_, report_);
    model::evaluate(model_, report_);
    model::lay_out(model_, report_);
    model::check(model_, report_);
    if (job_.is_strict) model::check_strictly(model_, report_);
    // A warning that is denied is no reason to leave out what languages say.
    const bool is_right = report_.errors() == 0;
    if (is_right && !make_products()) return exit_errors;
    return end();
  }

  /// Files and texts; false when a rename of the command line is wrong, which is said.
  bool make_products() {
    for (const Target& target : job_.targets) {
      if (!rename(target)) return false;
      if (options_.command == Command::view) {
        text_ = target.backend->view(model_, report_);
      } else {
        outputs_.push_back({&target, generate(target)});
      }
    }
    if (options_.command == Command::describe) text_ = outlines(model_);
    if (options_.command == Command::model) text_ = model::dump(model_, sources_);
    return true;
  }

  FileSet generate(const Target& target) {
    if (target.plugin) {
      return plugin::generate(*target.plugin, model_, sources_, target.folder, report_, err_);
    }
    if (target.backend == nullptr) return docs::make_pages(model_, options_.docs_form);
    try {
      return target.backend->generate(model_, {.template_folder = target.template_folder}, report_);
    } catch (const TemplateError& error) {
      // A fault in our own templates is ours.
      if (target.template_folder.empty()) throw;
      throw UserTemplateError(error.what());
    }
  }

  bool rename(const Target& target) {
    for (const model::RenameFault& fault : model::rename(model_, target.renames)) {
      if (!fault.rename->place) {
        err_ << "robdef: " << fault.text() << '\n';
        return false;
      }
      // A part of a project need not have all of its definitions.
      if (fault.is_outside && !options_.inputs.empty()) continue;
      Diagnostic& diagnostic = report_.add(Code::R0805, *fault.rename->place,
                                           "cannot rename `" + fault.rename->path + "`");
      diagnostic.label(fault.what);
      if (!fault.near.empty()) diagnostic.help("did you mean `" + fault.near + "`?");
    }
    return true;
  }

  /// Prints the findings, then delivers what was made if none is an error.
  ExitStatus end() {
    print_findings(report_, sources_, options_, out_, err_);
    return report_.has_errors() ? exit_errors : deliver();
  }

  ExitStatus deliver() {
    out_ << text_;
    if (options_.lists_outputs) {
      for (const std::string& path : output_paths(outputs_)) out_ << path << '\n';
    } else if (writes_files(options_)) {
      const std::string failure = write_files();
      if (!failure.empty()) {
        err_ << "robdef: " << shortened(failure) << '\n';
        return exit_errors;
      }
      if (options_.format != Format::text) return exit_fine;
      for (const Output& output : outputs_) {
        for (const std::string& note : output.files.notes()) err_ << note << '\n';
      }
    }
    return exit_fine;
  }

  /// All outputs of all languages, the make rule among them, or none. Why not; empty when all are
  /// written.
  [[nodiscard]] std::string write_files() {
    const std::vector<std::string> paths = output_paths(outputs_);
    std::set<std::string> made;
    for (const std::string& path : paths) {
      if (!made.insert(path).second) return path + ": two languages would write it";
    }
    PendingFiles pending;
    for (const Output& output : outputs_) {
      std::string failure = output.files.prepare(output.target->folder, pending).failure;
      if (!failure.empty()) return failure;
    }
    std::vector<Stale> stale;
    if (job_.is_whole_project) {
      for (const Output& output : outputs_) {
        std::string failure = prepare_manifest(output, made, stale, pending);
        if (!failure.empty()) return failure;
      }
    }
    if (!options_.depfile.empty()) {
      FileSet depfile;
      const std::filesystem::path path = options_.depfile;
      depfile.add(
          path.filename().generic_string(),
          depfile_text(
              options_.depfile_target.empty() ? paths : std::vector{options_.depfile_target},
              input_paths(sources_, job_.targets)));
      std::string failure =
          depfile.prepare(path.has_parent_path() ? path.parent_path() : ".", pending).failure;
      if (!failure.empty()) return failure;
    }
    std::string failure = pending.move_all();
    if (failure.empty()) clean_up(stale);
    return failure;
  }

  /// Writes down what is made for one language, and finds what is no longer made for it.
  static std::string prepare_manifest(const Output& output, const std::set<std::string>& made,
                                      std::vector<Stale>& stale, PendingFiles& pending) {
    const std::string& folder = output.target->folder;
    const std::string& language = output.target->name;
    const std::string name = Manifest::file_name(language);
    const Manifest before = Manifest::read(std::filesystem::path(folder) / name);
    Manifest now(output.files);
    const auto is_made = [&](const std::string& path) {
      return made.contains(below(folder, path)) || output.files.contains(path);
    };
    for (std::string& path : now.stale(before, is_made)) {
      std::error_code error;
      if (!std::filesystem::exists(std::filesystem::path(folder) / path, error)) continue;
      const bool is_edited = !before.is_unedited(folder, path);
      if (is_edited) now.keep(path, before);
      stale.push_back({&output, std::move(path), is_edited});
    }
    FileSet manifest;
    manifest.add(name, now.text(language));
    return manifest.prepare(folder, pending).failure;
  }

  void clean_up(const std::vector<Stale>& stale) {
    for (const Stale& one : stale) {
      const std::string& folder = one.output->target->folder;
      const std::string path = below(folder, one.path);
      if (one.is_edited) {
        err_ << "robdef: warning: " << path
             << " is no longer generated, and was edited: it stays until you remove it\n";
      } else if (!remove_output(folder, one.path)) {
        err_ << "robdef: warning: " << path << " is no longer generated, and cannot be removed\n";
      }
    }
  }

  const Options& options_;
  std::ostream& out_;
  std::ostream& err_;
  Sources sources_;
  Report report_;
  Job job_;
  model::Model model_;
  std::string text_;
  std::vector<Output> outputs_;
};

}  // namespace

ExitStatus compile(const Options& options, std::ostream& out, std::ostream& err) {
  try {
    return Run(options, out, err).run();
  } catch (const UserTemplateError& error) {
    err << "robdef: " << error.what() << '\n';
    return exit_errors;
  } catch (const plugin::PluginError& error) {
    err << "robdef: " << shortened(error.what()) << '\n';
    return exit_errors;
  }
}

}  // namespace robdef
