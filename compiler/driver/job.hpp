// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/backends/backend.hpp"
#include "compiler/driver/options.hpp"
#include "compiler/plugin/plugin.hpp"
#include "compiler/project/project.hpp"

namespace robdef {

/// A language that is generated or checked, what a plug-in makes, or the pages of `robdef docs`.
struct Target {
  const Backend* backend = nullptr;  ///< null: a plug-in or pages
  std::optional<plugin::Plugin> plugin;
  std::string name;             ///< of the language, or `plugin-NAME`; empty: pages
  std::string folder = ".";     ///< to write below
  std::string template_folder;  ///< empty: the templates of the backend
  std::vector<model::Rename> renames;
};

/// What one run works on: the command line over the project file.
struct Job {
  std::vector<std::string> inputs;
  ast::SearchPath search_path;  ///< those of `-I`, of the project, of the environment
  std::vector<Target> targets;
  bool is_strict = false;
  /// Inputs and languages are those of the project file, all of them.
  bool is_whole_project = false;
};

/// `project` may be null. Puts what is missing, or cannot be together, into `complaint`.
Job make_job(const Options& options, const project::Project* project, std::string& complaint);

}  // namespace robdef
