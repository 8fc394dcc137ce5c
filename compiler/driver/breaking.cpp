// SPDX-License-Identifier: Apache-2.0
#include "compiler/driver/breaking.hpp"

#include <optional>
#include <ostream>

#include "compiler/breaking/compare.hpp"
#include "compiler/breaking/render.hpp"
#include "compiler/driver/version.hpp"

namespace robdef {

ExitStatus breaking_changes(const Options& options, std::ostream& out, std::ostream& err) {
  Sources sources;
  const std::optional<Version> before = read_version(options.inputs[0], options, sources, err);
  const std::size_t first_new = sources.size();
  const std::optional<Version> now = read_version(options.inputs[1], options, sources, err);
  if (!before || !now) return exit_usage;

  breaking::Wanted wanted = options.breaking.wanted;
  if (wanted.categories.is_empty()) wanted.categories = breaking::Categories::all();
  breaking::Changes changes(wanted);
  breaking::compare(before->model, now->model, now->is_partial, changes);

  switch (options.breaking.form) {
    case BreakingOptions::Form::text:
      out << breaking::to_text(changes, sources);
      break;
    case BreakingOptions::Form::json:
      out << breaking::to_json(changes, sources, before->name, now->name);
      break;
    case BreakingOptions::Form::github:
      out << breaking::to_github(changes, sources, [&](SourceId id) {
        const bool is_new = static_cast<std::size_t>(id) >= first_new;
        return is_new ? now->is_in_files : before->is_in_files;
      });
      break;
  }
  return changes.count() == 0 ? exit_fine : exit_errors;
}

}  // namespace robdef
