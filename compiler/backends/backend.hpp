// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/report.hpp"
#include "compiler/model/model.hpp"
#include "compiler/output/file_set.hpp"

/// What turns a model into the source files of one language.
namespace robdef {

/// What a target can express or its runtime can serve. What is missing is reported at the place
/// that asks for it, and nothing is generated there.
struct Abilities {
  bool properties = false;
  bool functions = false;
  bool generators = false;
  bool events = false;
  bool objrefs = false;
  bool pipes = false;
  bool callbacks = false;
  bool wires = false;
  bool memories = false;
  bool contained_memories = false;  ///< memories in a list or map

  /// Whether this member can be served.
  [[nodiscard]] bool serve(const model::Member& member) const;
  /// Whether a service has to implement a member of this object, so that there is something for a
  /// default class to do: a property, function, objref or memory that can be served.
  [[nodiscard]] bool must_implement(const model::Object& object) const;
};

/// All members but memories in a list or map, which mean nothing on the wire.
inline constexpr Abilities all_members{.properties = true,
                                       .functions = true,
                                       .generators = true,
                                       .events = true,
                                       .objrefs = true,
                                       .pipes = true,
                                       .callbacks = true,
                                       .wires = true,
                                       .memories = true};

/// All, whatever they mean.
inline constexpr Abilities everything = [] {
  Abilities abilities = all_members;
  abilities.contained_memories = true;
  return abilities;
}();

/// What the user chose beyond the language.
struct GenerateOptions {
  /// A folder of templates (its README: compiler/backends/README.md). With a file `outputs.json` in
  /// it, these are all that is generated; without one, its templates and partials replace the
  /// backend's own of the same name. Empty: none.
  std::string template_folder;
};

class Backend {
 public:
  virtual ~Backend() = default;

  /// As in `--lang cpp`.
  [[nodiscard]] virtual std::string_view name() const = 0;
  /// One line for `--help`.
  [[nodiscard]] virtual std::string_view summary() const = 0;
  [[nodiscard]] virtual const Abilities& abilities() const = 0;

  /// The files for all definitions of the model that are no imports. Reports R09xx; when that was
  /// an error the files are not to be written. Throws TemplateError for a fault in a template.
  [[nodiscard]] virtual FileSet generate(const model::Model& model, const GenerateOptions& options,
                                         Report& report) const = 0;
  /// The view that generate() gives to the templates, as JSON.
  [[nodiscard]] virtual std::string view(const model::Model& model, Report& report) const = 0;
};

/// All backends, in the order in which they are listed to users.
const std::vector<const Backend*>& backends();
/// nullptr when there is none of that name.
const Backend* find_backend(std::string_view name);

}  // namespace robdef
