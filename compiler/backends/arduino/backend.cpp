// SPDX-License-Identifier: Apache-2.0
// The whole of the backend: model -> view -> templates -> files.
#include "compiler/backends/arduino/backend.hpp"

#include <stdexcept>

#include "compiler/backends/arduino/templates.hpp"
#include "compiler/backends/arduino/view.hpp"
#include "compiler/output/template_folder.hpp"
#include "compiler/output/view_type.hpp"

namespace robdef::arduino {
namespace {

void print(const TemplateFolder& folder, const OutputRule& rule, const ModelView& view,
           FileSet& files) {
  if (rule.subject != "service" && rule.subject != "draft") {
    throw TemplateError(TemplateFolder::rules_name, rule.line,
                        "`" + rule.subject + "` is no subject; there are service and draft");
  }
  const std::vector<const ViewType*> types{&view_type<ModelView>(), &view_type<ServiceView>()};
  const Template text(folder.sources, rule.name, types);
  const Template path(folder.sources, TemplateFolder::rules_name, rule.path, types);
  for (const ServiceView& service : view.services) {
    try {
      const std::vector<const void*> views{&view, &service};
      if (rule.subject == "draft") {
        files.add_draft(path.render(views), text.render(views));
      } else {
        files.add(path.render(views), text.render(views));
      }
    } catch (const std::logic_error& error) {
      throw TemplateError(TemplateFolder::rules_name, rule.line, error.what());
    }
  }
}

}  // namespace

std::string_view ArduinoBackend::summary() const {
  return "a sketch that serves the definition over a serial port";
}

FileSet ArduinoBackend::generate(const model::Model& model, const GenerateOptions& options,
                                 Report& report) const {
  FileSet files;
  const ModelView view = make_view(model, report);
  if (report.has_errors()) return files;
  TemplateFolder folder = TemplateFolder::from_sources(embedded_templates());
  if (!options.template_folder.empty()) {
    folder = folder.overlaid_with(TemplateFolder::from_disk(options.template_folder));
  }
  for (const OutputRule& rule : folder.rules) print(folder, rule, view, files);
  for (const ServiceView& service : view.services) files.add_note(service.estimate);
  return files;
}

std::string ArduinoBackend::view(const model::Model& model, Report& report) const {
  return view_json(make_view(model, report));
}

}  // namespace robdef::arduino
