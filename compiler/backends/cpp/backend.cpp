// SPDX-License-Identifier: Apache-2.0
// The whole of the backend: model -> view -> templates -> files.
#include "compiler/backends/cpp/backend.hpp"

#include <stdexcept>
#include <utility>
#include <vector>

#include "compiler/backends/cpp/templates.hpp"
#include "compiler/backends/cpp/view.hpp"
#include "compiler/output/template_folder.hpp"
#include "compiler/output/view_type.hpp"

namespace robdef::cpp {
namespace {

/// Prints one template for one subject after the other.
class Rule {
 public:
  Rule(const TemplateFolder& folder, const OutputRule& rule,
       const std::vector<const ViewType*>& types)
      : rule_(rule),
        text_(folder.sources, rule.name, types),
        path_(folder.sources, TemplateFolder::rules_name, rule.path, types) {}

  void print(const std::vector<const void*>& views, FileSet& files) const {
    try {
      files.add(path_.render(views), text_.render(views));
    } catch (const std::logic_error& error) {
      throw TemplateError(TemplateFolder::rules_name, rule_.line, error.what());
    }
  }

 private:
  const OutputRule& rule_;
  Template text_;
  Template path_;
};

void print_objects(const TemplateFolder& folder, const OutputRule& rule, const ModelView& view,
                   FileSet& files) {
  const Rule printer(
      folder, rule,
      {&view_type<ModelView>(), &view_type<DefinitionView>(), &view_type<ObjectView>()});
  for (const DefinitionView& definition : view.definitions) {
    for (const DeclarationView& declaration : definition.declarations) {
      if (declaration.object) printer.print({&view, &definition, &*declaration.object}, files);
    }
  }
}

void print(const TemplateFolder& folder, const OutputRule& rule, const ModelView& view,
           FileSet& files) {
  if (rule.subject == "all") {
    Rule(folder, rule, {&view_type<ModelView>()}).print({&view}, files);
  } else if (rule.subject == "definition") {
    const Rule printer(folder, rule, {&view_type<ModelView>(), &view_type<DefinitionView>()});
    for (const DefinitionView& definition : view.definitions) {
      printer.print({&view, &definition}, files);
    }
  } else if (rule.subject == "object") {
    print_objects(folder, rule, view, files);
  } else {
    throw TemplateError(
        TemplateFolder::rules_name, rule.line,
        "`" + rule.subject + "` is no subject; there are all, definition and object");
  }
}

}  // namespace

std::string_view CppBackend::summary() const { return "C++20: stubs, skeletons and value types"; }

FileSet CppBackend::generate(const model::Model& model, const GenerateOptions& options,
                             Report& report) const {
  FileSet files;
  const ModelView view = make_view(model, report);
  if (report.has_errors()) return files;
  TemplateFolder folder = TemplateFolder::from_sources(embedded_templates());
  if (!options.template_folder.empty()) {
    folder = folder.overlaid_with(TemplateFolder::from_disk(options.template_folder));
  }
  for (const OutputRule& rule : folder.rules) print(folder, rule, view, files);
  return files;
}

std::string CppBackend::view(const model::Model& model, Report& report) const {
  return view_json(make_view(model, report));
}

}  // namespace robdef::cpp
