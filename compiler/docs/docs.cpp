// SPDX-License-Identifier: Apache-2.0
#include "compiler/docs/docs.hpp"

#include <string>
#include <string_view>

#include "compiler/docs/templates.hpp"
#include "compiler/docs/view.hpp"
#include "compiler/output/view_type.hpp"

namespace robdef::docs {
namespace {

void add_definition_pages(const TemplateSources& sources, std::string_view name,
                          const ModelView& view, FileSet& files) {
  const Template page(sources, name, {&view_type<ModelView>(), &view_type<DefinitionView>()});
  for (const DefinitionView& definition : view.definitions) {
    files.add(definition.file, page.render({&view, &definition}));
  }
}

void add_model_page(const TemplateSources& sources, std::string_view name, const std::string& path,
                    const ModelView& view, FileSet& files) {
  files.add(path, Template(sources, name, {&view_type<ModelView>()}).render({&view}));
}

}  // namespace

FileSet make_pages(const model::Model& model, Form form) {
  const TemplateSources sources = embedded_templates();
  ModelView view = make_view(model, form);
  FileSet files;
  if (form == Form::markdown) {
    add_definition_pages(sources, "definition.md.mustache", view, files);
    add_model_page(sources, "index.md.mustache", view.index, view, files);
    return files;
  }
  view.style = sources.at("style.css");
  view.script = sources.at("script.js");
  add_definition_pages(sources, "definition.html.mustache", view, files);
  add_model_page(sources, "index.html.mustache", view.index, view, files);
  add_model_page(sources, "search.js.mustache", "search.js", view, files);
  return files;
}

}  // namespace robdef::docs
