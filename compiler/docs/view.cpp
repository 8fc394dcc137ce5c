// SPDX-License-Identifier: Apache-2.0
// Model -> view of all pages. Declarations are made in declaration_view.cpp.
#include "compiler/docs/view.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

#include "compiler/docs/search.hpp"
#include "compiler/docs/view_parts.hpp"

namespace robdef::docs {
namespace {

std::string link_to(const model::Definition& to, const Context& context) {
  return context.markup.link(context.markup.text(to.name),
                             context.addresses.address(context.definition, {&to, ""}));
}

AliasView make_alias(const model::Alias& alias, const Context& context) {
  const std::string label = context.markup.text(alias.qualified_name);
  const Place* place = context.addresses.find(alias.qualified_name);
  return {.name = context.markup.text(alias.name),
          .link = place == nullptr ? label
                                   : context.markup.link(label, context.addresses.address(
                                                                    context.definition, *place))};
}

std::string summary_of(const std::string& documentation, const Markup& markup) {
  std::vector<Block> blocks = blocks_of(documentation);
  if (blocks.size() > 1) blocks.resize(1);
  return markup.one_line(blocks);
}

DefinitionView make_definition(const Context& context) {
  const model::Definition& definition = context.definition;
  const Markup& markup = context.markup;
  DefinitionView view;
  view.name = markup.text(definition.name);
  view.file = context.addresses.page(definition);
  view.page = context.addresses.address({&definition, ""});
  if (definition.version_spelling != ast::VersionSpelling::none) {
    view.version = model::text_of(definition.version);
  }
  view.is_import = definition.is_import;
  view.summary = summary_of(definition.documentation, markup);
  view.doc = markup.lines(blocks_of(definition.documentation));
  std::vector<std::string> links;
  for (const model::Definition* import : definition.imports) {
    links.push_back(link_to(*import, context));
  }
  view.imports = joined(links);
  links.clear();
  for (const Place& place : context.uses.importers_of(definition)) {
    links.push_back(link_to(*place.definition, context));
  }
  view.imported_by = joined(links);
  for (const model::Alias& alias : definition.aliases) {
    view.aliases.push_back(make_alias(alias, context));
  }
  for (const std::string& option : definition.options) {
    view.options.push_back(markup.text("option " + option));
  }
  view.sections = make_sections(context);
  return view;
}

void add_types(const model::Definition& definition, const Addresses& addresses,
               const Markup& markup, std::vector<TypeView>& types) {
  const auto add = [&](const auto& one, std::string_view kind) {
    types.push_back({.name = markup.text(one.name),
                     .address = addresses.address(Place{&definition, one.name}),
                     .kind = std::string(kind),
                     .definition = markup.text(definition.name)});
  };
  for (const model::Object& object : definition.objects) add(object, "object");
  for (const model::Record& record : definition.records) add(record, model::name_of(record.kind));
  for (const model::Enum& enumeration : definition.enums) add(enumeration, "enum");
  for (const model::Exception& exception : definition.exceptions) add(exception, "exception");
}

bool is_before(const TypeView& one, const TypeView& other) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  const auto order = std::lexicographical_compare_three_way(
      one.name.begin(), one.name.end(), other.name.begin(), other.name.end(),
      [&](char a, char b) { return lower(a) <=> lower(b); });
  if (order != 0) return order < 0;
  return std::pair(one.name, one.definition) < std::pair(other.name, other.definition);
}

}  // namespace

std::string joined(const std::vector<std::string>& links) {
  std::string text;
  for (const std::string& link : links) text += (text.empty() ? "" : ", ") + link;
  return text;
}

ModelView make_view(const model::Model& model, Form form) {
  const Markup& markup = markup_of(form);
  const Addresses addresses(model, markup.extension());
  const Uses uses(model);
  ModelView view;
  view.index = addresses.index();
  for (const model::Definition* definition : by_name(model)) {
    const Signatures signatures(*definition, addresses, markup);
    view.definitions.push_back(make_definition({*definition, addresses, markup, uses, signatures}));
    view.definitions.back().search_index =
        search_index(addresses.page(*definition), definition->name, searched(*definition));
    add_types(*definition, addresses, markup, view.types);
  }
  std::ranges::sort(view.types, is_before);
  return view;
}

}  // namespace robdef::docs
