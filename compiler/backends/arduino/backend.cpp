// SPDX-License-Identifier: Apache-2.0
// The whole of the backend: model -> view -> templates -> files.
#include "compiler/backends/arduino/backend.hpp"

#include <stdexcept>

#include "compiler/backends/arduino/templates.hpp"
#include "compiler/backends/arduino/view.hpp"
#include "compiler/backends/print.hpp"
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
  const ModelView view = make_view(model, report);
  if (report.has_errors()) return {};
  FileSet files = print_rules(embedded_templates(), options.template_folder,
                              [&](const TemplateFolder& folder, const OutputRule& rule,
                                  FileSet& printed) { print(folder, rule, view, printed); });
  for (const ServiceView& service : view.services) files.add_note(service.estimate);
  return files;
}

std::string ArduinoBackend::view(const model::Model& model, Report& report) const {
  return view_json(make_view(model, report));
}

const Backend& backend() {
  static const ArduinoBackend only;
  return only;
}

}  // namespace robdef::arduino
