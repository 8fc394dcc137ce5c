// SPDX-License-Identifier: Apache-2.0
#include "compiler/driver/job.hpp"

#include <cstddef>
#include <map>
#include <string_view>

namespace robdef {
namespace {

ast::SearchPath search_path(const Options& options, const project::Project* project) {
  ast::SearchPath path = options.search_path;
  if (project == nullptr) return path;
  path.folders.insert(
      path.folders.begin() + static_cast<std::ptrdiff_t>(options.own_import_folders),
      project->import_folders.begin(), project->import_folders.end());
  return path;
}

/// What the project file says (it may say nothing), and the command line over it.
void fill(Target& target, const project::Language* language, const Options& options) {
  if (language != nullptr) {
    if (!language->output_folder.empty()) target.folder = language->output_folder;
    target.template_folder = language->template_folder;
    target.renames = language->renames;
  }
  if (!options.output_folder.empty()) target.folder = options.output_folder;
  if (!options.template_folder.empty()) target.template_folder = options.template_folder;
  // Later ones count.
  target.renames.insert(target.renames.end(), options.renames.begin(), options.renames.end());
}

Target make_target(std::string_view name, const Options& options, const project::Project* project) {
  Target target;
  target.backend = find_backend(name);
  target.name = name;
  fill(target, project == nullptr ? nullptr : project->find(name), options);
  return target;
}

Target make_plugin_target(const std::string& program, const project::Plugin* found,
                          const Options& options) {
  Target target;
  std::map<std::string, std::string> told = options.plugin_options;
  if (found != nullptr) told.insert(found->options.begin(), found->options.end());
  target.plugin =
      plugin::Plugin{found == nullptr ? program : found->program, {told.begin(), told.end()}};
  target.name = "plugin-" + (found == nullptr ? program : found->name);
  fill(target, found, options);
  return target;
}

std::vector<Target> make_targets(const Options& options, const project::Project* project) {
  std::vector<Target> targets;
  if (options.command == Command::docs) {
    targets.emplace_back().folder = options.output_folder;
    return targets;
  }
  for (const std::string& language : options.languages) {
    targets.push_back(make_target(language, options, project));
  }
  if (!options.plugin.empty()) {
    const project::Plugin* const found =
        project == nullptr ? nullptr : project->find_plugin(options.plugin);
    targets.push_back(make_plugin_target(options.plugin, found, options));
  }
  if (!targets.empty() || options.command != Command::generate || project == nullptr) {
    return targets;
  }
  for (const project::Language& language : project->languages) {
    if (language.output_folder.empty()) continue;
    targets.push_back(make_target(language.name, options, project));
  }
  for (const project::Plugin& plugin : project->plugins) {
    if (plugin.output_folder.empty()) continue;
    targets.push_back(make_plugin_target(plugin.name, &plugin, options));
  }
  return targets;
}

/// What belongs to one language, without one.
std::string_view alone(const Options& options) {
  if (!options.output_folder.empty()) return "`--output`";
  if (!options.template_folder.empty()) return "`--templates`";
  return options.renames.empty() ? "" : "`--rename`";
}

std::string complaint_of_plugin(const Options& options) {
  if (options.plugin.empty()) {
    return options.plugin_options.empty() ? "" : "`--plugin-option` needs `--plugin`";
  }
  if (!options.languages.empty()) return "give either `--lang` or `--plugin`";
  return options.template_folder.empty() ? "" : "`--templates` is for languages, not for plug-ins";
}

std::string complaint_of(const Job& job, const Options& options, const project::Project* project) {
  const std::string no_language =
      "; " + (project == nullptr ? "" : project->path) + " says `output` of no language";
  if (job.inputs.empty()) {
    return project == nullptr ? "no file given"
                              : "no file given; " + project->path + " has no inputs";
  }
  if (options.command == Command::docs) {
    // No folder by default: pages have names that others have, too, such as index.html.
    return options.output_folder.empty() ? "`--output` is missing" : "";
  }
  const bool needs_target =
      options.command == Command::generate || options.command == Command::view;
  if (!needs_target) return "";
  if (std::string complaint = complaint_of_plugin(options); !complaint.empty()) return complaint;
  if (job.targets.empty()) {
    const bool has_project = project != nullptr && options.command == Command::generate;
    return "`--lang` is missing" + (has_project ? no_language : "");
  }
  const std::string_view option = alone(options);
  if (options.languages.empty() && options.plugin.empty() && !option.empty())
    return std::string(option) + " needs `--lang`";
  return "";
}

}  // namespace

Job make_job(const Options& options, const project::Project* project, std::string& complaint) {
  Job job;
  const bool has_inputs = !options.inputs.empty();
  job.inputs = has_inputs || project == nullptr ? options.inputs : project->inputs;
  job.search_path = search_path(options, project);
  job.targets = make_targets(options, project);
  job.is_strict = options.is_strict ||
                  (project != nullptr && project->is_strict && options.command == Command::check);
  job.is_whole_project = options.command == Command::generate && project != nullptr &&
                         !has_inputs && options.languages.empty() && options.plugin.empty();
  complaint = complaint_of(job, options, project);
  return job;
}

}  // namespace robdef
