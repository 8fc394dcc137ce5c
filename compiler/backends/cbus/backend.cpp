// SPDX-License-Identifier: Apache-2.0
// The whole of the backend: model -> view -> templates -> files.
#include "compiler/backends/cbus/backend.hpp"

#include "compiler/backends/cbus/templates.hpp"
#include "compiler/backends/cbus/view.hpp"
#include "compiler/backends/print.hpp"
#include "compiler/output/template_folder.hpp"

namespace robdef::cbus {
namespace {

void print_rule(const TemplateFolder& folder, const OutputRule& rule, const ModelView& view,
                FileSet& files) {
  std::vector<const ViewType*> types{&view_type<ModelView>(), &view_type<DefinitionView>()};
  if (rule.subject == "definition") {
    const OutputPrinter printer(folder, rule, types);
    for (const DefinitionView& definition : view.definitions) {
      printer.print({&view, &definition}, files);
    }
  } else if (rule.subject == "bus") {
    types.push_back(&view_type<RecordView>());
    const OutputPrinter printer(folder, rule, types);
    for (const DefinitionView& definition : view.definitions) {
      for (const RecordView& record : definition.records) {
        if (record.is_bus) printer.print({&view, &definition, &record}, files);
      }
    }
  } else {
    throw TemplateError(TemplateFolder::rules_name, rule.line,
                        "`" + rule.subject + "` is no subject; there are definition and bus");
  }
}

}  // namespace

std::string_view CBusBackend::summary() const {
  return "pods as buses of real-time nodes, in C99 and for Simulink";
}

FileSet CBusBackend::generate(const model::Model& model, const GenerateOptions& options,
                              Report& report) const {
  const ModelView view = make_view(model, report);
  if (report.has_errors()) return {};
  return print_rules(embedded_templates(), options.template_folder,
                     [&](const TemplateFolder& folder, const OutputRule& rule, FileSet& files) {
                       print_rule(folder, rule, view, files);
                     });
}

std::string CBusBackend::view(const model::Model& model, Report& report) const {
  return view_json(make_view(model, report));
}

const Backend& backend() {
  static const CBusBackend only;
  return only;
}

}  // namespace robdef::cbus
