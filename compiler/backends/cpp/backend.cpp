// SPDX-License-Identifier: Apache-2.0
// The whole of the backend: model -> view -> templates -> files.
#include "compiler/backends/cpp/backend.hpp"

#include "compiler/backends/cpp/templates.hpp"
#include "compiler/backends/cpp/view.hpp"
#include "compiler/backends/print.hpp"

namespace robdef::cpp {

std::string_view CppBackend::summary() const { return "C++20: stubs, skeletons and value types"; }

FileSet CppBackend::generate(const model::Model& model, const GenerateOptions& options,
                             Report& report) const {
  const ModelView view = make_view(model, report);
  if (report.has_errors()) return {};
  return print_view<ModelView, DefinitionView>(view, embedded_templates(), options.template_folder);
}

std::string CppBackend::view(const model::Model& model, Report& report) const {
  return view_json(make_view(model, report));
}

const Backend& backend() {
  static const CppBackend only;
  return only;
}

}  // namespace robdef::cpp
