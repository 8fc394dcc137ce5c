// SPDX-License-Identifier: Apache-2.0
// The whole of the backend: model -> view -> templates -> files.
#include "compiler/backends/typescript/backend.hpp"

#include "compiler/backends/print.hpp"
#include "compiler/backends/typescript/templates.hpp"
#include "compiler/backends/typescript/view.hpp"

namespace robdef::typescript {

std::string_view TypeScriptBackend::summary() const {
  return "TypeScript: interfaces, stubs, skeletons and value types";
}

FileSet TypeScriptBackend::generate(const model::Model& model, const GenerateOptions& options,
                                    Report& report) const {
  const ModelView view = make_view(model, report);
  if (report.has_errors()) return {};
  return print_view<ModelView, DefinitionView>(view, embedded_templates(), options.template_folder);
}

std::string TypeScriptBackend::view(const model::Model& model, Report& report) const {
  return view_json(make_view(model, report));
}

const Backend& backend() {
  static const TypeScriptBackend only;
  return only;
}

}  // namespace robdef::typescript
