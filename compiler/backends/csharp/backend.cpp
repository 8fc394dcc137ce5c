// SPDX-License-Identifier: Apache-2.0
// The whole of the backend: model -> view -> templates -> files.
#include "compiler/backends/csharp/backend.hpp"

#include "compiler/backends/csharp/templates.hpp"
#include "compiler/backends/csharp/view.hpp"
#include "compiler/backends/print.hpp"

namespace robdef::csharp {

std::string_view CSharpBackend::summary() const {
  return "C# for .NET 8 and later: interfaces, stubs, skeletons, types";
}

FileSet CSharpBackend::generate(const model::Model& model, const GenerateOptions& options,
                                Report& report) const {
  const ModelView view = make_view(model, report);
  if (report.has_errors()) return {};
  return print_view<ModelView, DefinitionView>(view, embedded_templates(), options.template_folder);
}

std::string CSharpBackend::view(const model::Model& model, Report& report) const {
  return view_json(make_view(model, report));
}

const Backend& backend() {
  static const CSharpBackend only;
  return only;
}

}  // namespace robdef::csharp
