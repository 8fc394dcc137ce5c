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
  FileSet files;
  const ModelView view = make_view(model, report);
  if (report.has_errors()) return files;
  TemplateFolder folder = TemplateFolder::from_sources(embedded_templates());
  if (!options.template_folder.empty()) {
    folder = folder.overlaid_with(TemplateFolder::from_disk(options.template_folder));
  }
  for (const OutputRule& rule : folder.rules) print_rule(folder, rule, view, files);
  return files;
}

std::string CBusBackend::view(const model::Model& model, Report& report) const {
  return view_json(make_view(model, report));
}

}  // namespace robdef::cbus
