// SPDX-License-Identifier: Apache-2.0
// The whole of the backend: model -> view -> templates -> files, and beside them the C++ that the
// client calls.
#include "compiler/backends/matlab/backend.hpp"

#include <string>

#include "compiler/backends/cpp/backend.hpp"
#include "compiler/backends/matlab/templates.hpp"
#include "compiler/backends/matlab/view.hpp"
#include "compiler/backends/print.hpp"

namespace robdef::matlab {
namespace {

/// The stubs go below client/cpp. What the C++ backend renames or leaves out is nothing that a user
/// of MATLAB sees; what it refuses is an error here too.
void add_stubs(const model::Model& model, FileSet& files, Report& report) {
  Report heard;
  const FileSet stubs = cpp::CppBackend().generate(model, {}, heard);
  for (const Diagnostic* finding : heard.sorted()) {
    if (finding->severity() != Severity::error) continue;
    report.add(finding->code(), finding->primary().span, finding->message())
        .label(finding->primary().text)
        .note("the client under the classes is C++");
  }
  for (const auto& [path, content] : stubs.files()) files.add("client/cpp/" + path, content);
}

}  // namespace

std::string_view MatlabBackend::summary() const {
  return "MATLAB and Octave: package classes and the MEX client under them";
}

FileSet MatlabBackend::generate(const model::Model& model, const GenerateOptions& options,
                                Report& report) const {
  const ModelView view = make_view(model, report);
  if (report.has_errors()) return {};
  FileSet files =
      print_view<ModelView, DefinitionView>(view, embedded_templates(), options.template_folder);
  if (options.template_folder.empty()) add_stubs(model, files, report);
  if (report.has_errors()) return {};
  return files;
}

std::string MatlabBackend::view(const model::Model& model, Report& report) const {
  return view_json(make_view(model, report));
}

const Backend& backend() {
  static const MatlabBackend only;
  return only;
}

}  // namespace robdef::matlab
