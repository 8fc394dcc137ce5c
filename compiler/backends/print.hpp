// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "compiler/output/file_set.hpp"
#include "compiler/output/template_folder.hpp"
#include "compiler/output/view_type.hpp"

/// How every backend's templates become files. The view of a backend has `definitions`, these have
/// `declarations`, and each of these may have an `object`, `record`, `enumeration` or `exception`.
namespace robdef {

/// Prints one template for one subject after the other.
class OutputPrinter {
 public:
  OutputPrinter(const TemplateFolder& folder, const OutputRule& rule,
                const std::vector<const ViewType*>& types)
      : rule_(rule),
        text_(folder.sources, rule.name, types),
        path_(folder.sources, TemplateFolder::rules_name, rule.path, types) {}

  /// Nothing where the name of the file is empty.
  void print(const std::vector<const void*>& views, FileSet& files) const {
    try {
      const std::string path = path_.render(views);
      if (!path.empty()) files.add(path, text_.render(views));
    } catch (const std::logic_error& error) {
      throw TemplateError(TemplateFolder::rules_name, rule_.line, error.what());
    }
  }

 private:
  const OutputRule& rule_;
  Template text_;
  Template path_;
};

/// Once for each declaration that has the view `Part`.
template <auto Part, class ModelView>
void print_declarations(const TemplateFolder& folder, const OutputRule& rule, const ModelView& view,
                        FileSet& files) {
  using DefinitionView = typename decltype(view.definitions)::value_type;
  using PartView = typename decltype(value_of(Part))::value_type;
  const OutputPrinter printer(
      folder, rule,
      {&view_type<ModelView>(), &view_type<DefinitionView>(), &view_type<PartView>()});
  for (const DefinitionView& definition : view.definitions) {
    for (const auto& declaration : definition.declarations) {
      const auto& part = declaration.*Part;
      if (part) printer.print({&view, &definition, &*part}, files);
    }
  }
}

/// Prints what one rule asks for. Throws TemplateError for a subject that there is not.
template <class ModelView, class DefinitionView>
void print_output(const TemplateFolder& folder, const OutputRule& rule, const ModelView& view,
                  FileSet& files) {
  using Declaration = typename decltype(DefinitionView::declarations)::value_type;
  const ViewType& all = view_type<ModelView>();
  if (rule.subject == "all") {
    OutputPrinter(folder, rule, {&all}).print({&view}, files);
  } else if (rule.subject == "definition") {
    const OutputPrinter printer(folder, rule, {&all, &view_type<DefinitionView>()});
    for (const DefinitionView& definition : view.definitions) {
      printer.print({&view, &definition}, files);
    }
  } else if (rule.subject == "object") {
    print_declarations<&Declaration::object>(folder, rule, view, files);
  } else if (rule.subject == "record") {
    print_declarations<&Declaration::record>(folder, rule, view, files);
  } else if (rule.subject == "enum") {
    print_declarations<&Declaration::enumeration>(folder, rule, view, files);
  } else if (rule.subject == "exception") {
    print_declarations<&Declaration::exception>(folder, rule, view, files);
  } else {
    throw TemplateError(TemplateFolder::rules_name, rule.line,
                        "`" + rule.subject +
                            "` is no subject; there are all, definition, object, record, enum and "
                            "exception");
  }
}

/// All files that `print_rule(templates, rule, files)` makes of the rules: by the templates that
/// were compiled in, and those of `folder` laid over them unless it is empty.
template <class PrintRule>
FileSet print_rules(TemplateSources embedded, const std::string& folder,
                    const PrintRule& print_rule) {
  FileSet files;
  TemplateFolder templates = TemplateFolder::from_sources(std::move(embedded));
  if (!folder.empty()) templates = templates.overlaid_with(TemplateFolder::from_disk(folder));
  for (const OutputRule& rule : templates.rules) print_rule(templates, rule, files);
  return files;
}

/// The same with the rules that most backends have.
template <class ModelView, class DefinitionView>
FileSet print_view(const ModelView& view, TemplateSources embedded, const std::string& folder) {
  return print_rules(std::move(embedded), folder,
                     [&](const TemplateFolder& templates, const OutputRule& rule, FileSet& files) {
                       print_output<ModelView, DefinitionView>(templates, rule, view, files);
                     });
}

}  // namespace robdef
