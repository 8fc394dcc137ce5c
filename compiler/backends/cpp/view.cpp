// SPDX-License-Identifier: Apache-2.0
// Model -> view: what is declared, in which order, with which headers. Members are made in
// member_view.cpp. Reports R0901 to R0904.
#include "compiler/backends/cpp/view.hpp"

#include <algorithm>
#include <memory>
#include <utility>
#include <variant>

#include "compiler/backends/cpp/literal_text.hpp"
#include "compiler/backends/cpp/order.hpp"
#include "compiler/backends/cpp/view_parts.hpp"
#include "compiler/output/cpp_layout.hpp"
#include "compiler/output/prose.hpp"

namespace robdef::cpp {

std::vector<std::string> doc_lines(const std::string& documentation, std::size_t indent) {
  std::vector<std::string> lines = prose(documentation, "/// ", line_width - indent - 1);
  // A backslash at its end would draw the next line into the comment.
  for (std::string& line : lines) {
    if (line.ends_with('\\')) line += '.';
  }
  return lines;
}

namespace {

class DefinitionMaker {
 public:
  DefinitionMaker(const model::Definition& definition, const model::Model& model, Report& report)
      : definition_(definition),
        names_(definition, model, report),
        types_(names_),
        context_{names_, types_, report} {}

  DefinitionView make() {
    make_names();
    make_imports();
    make_aliases();
    const std::vector<model::Declaration> order = in_cpp_order(definition_);
    for (const model::Declaration& early : named_early(order)) add_forward(early);
    for (const model::Declaration& declaration : order) {
      view_.declarations.push_back(
          std::visit([&](const auto* declared) { return make(*declared); }, declaration));
    }
    make_groups();
    view_.has_aliases = !view_.aliases.empty();
    view_.has_forwards = !view_.forwards.empty();
    view_.text = literal_text(definition_.text);
    types_.include("<rr/stub.hpp>");
    view_.includes.assign(types_.headers().begin(), types_.headers().end());
    return std::move(view_);
  }

 private:
  void make_names() {
    view_.wire_name = definition_.name;
    view_.space = namespace_of(definition_.name);
    view_.qualified = "::" + view_.space;
    view_.path = path_of(definition_.name);
    view_.header = view_.path + ".hpp";
    view_.doc = doc_lines(definition_.documentation, 0);
    for (const std::uint32_t number : definition_.version.numbers) {
      view_.version.push_back(std::to_string(number));
    }
  }

  void make_imports() {
    for (const model::Definition* import : definition_.imports) {
      const std::string header = path_of(import->name) + ".hpp";
      view_.imports.push_back({.wire_name = import->name,
                               .header = header,
                               .qualified = "::" + namespace_of(import->name)});
      view_.import_includes.push_back("\"" + header + "\"");
    }
    std::ranges::sort(view_.import_includes);
    view_.has_imports = !view_.imports.empty();
  }

  /// Types and exceptions keep their aliases. Objects are classes of other names, and constants are
  /// not reached through aliases in the language either.
  void make_aliases() {
    for (const model::Alias& alias : definition_.aliases) {
      const std::size_t dot = alias.qualified_name.rfind('.');
      const std::string target = alias.qualified_name.substr(dot + 1);
      for (const model::Definition* import : definition_.imports) {
        if (alias.qualified_name.substr(0, dot) != import->name) continue;
        const std::string name = type_name(*import, target);
        if (name.empty()) continue;
        view_.aliases.push_back(
            {.name = identifier(alias.name), .target = qualified(*import, identifier(name))});
      }
    }
  }

  /// What a record, enum or exception is called in code; empty when there is none of that name.
  static std::string type_name(const model::Definition& definition, const std::string& name) {
    std::string found;
    const auto look = [&](const auto& all) {
      for (const auto& one : all) {
        if (one.name == name) found = code_name(one);
      }
    };
    look(definition.records);
    look(definition.enums);
    look(definition.exceptions);
    return found;
  }

  void add_forward(const model::Declaration& early) {
    if (const auto* record = std::get_if<const model::Record*>(&early)) {
      view_.forwards.push_back({.name = identifier(code_name(**record)), .is_struct = true});
    } else if (const auto* object = std::get_if<const model::Object*>(&early)) {
      view_.forwards.push_back({.name = stub_name(**object)});
      view_.forwards.push_back({.name = skeleton_name(**object)});
    }
  }

  DeclarationView make(const model::Constant& constant) {
    DeclarationView view;
    view.constant = make_constant(constant, false, context_);
    return view;
  }
  DeclarationView make(const model::Exception& exception) {
    DeclarationView view;
    view.exception = make_exception(exception, context_);
    view_.has_exceptions = true;
    return view;
  }
  DeclarationView make(const model::Enum& enumeration) {
    types_.include("<cstdint>");
    DeclarationView view;
    view.enumeration = make_enum(enumeration, context_);
    view.is_early = std::ranges::any_of(view.enumeration->values, [&](const EnumValueView& value) {
      return names_.is_variable(value.name);
    });
    view_.has_early |= view.is_early;
    return view;
  }
  DeclarationView make(const model::Record& record) {
    DeclarationView view;
    view.record = make_record(record, context_);
    view_.has_records = true;
    view_.has_fields |= view.record->has_fields && !view.record->is_namedarray;
    return view;
  }
  DeclarationView make(const model::Object& object) {
    DeclarationView view;
    view.object = make_object(object, context_);
    view_.has_objects = true;
    for (const char* header :
         {"<cstddef>", "<memory>", "<rr/answer.hpp>", "<rr/skeleton.hpp>", "<utility>"}) {
      types_.include(header);
    }
    if (view.object->has_default) types_.include("<rr/stored.hpp>");
    return view;
  }

  /// Short constants that follow each other stand together.
  void make_groups() {
    const auto is_short = [](const DeclarationView& view) {
      return view.constant && view.constant->doc.empty() && !view.constant->is_struct;
    };
    for (std::size_t i = 0; i < view_.declarations.size(); ++i) {
      const bool joins = i + 1 < view_.declarations.size() && is_short(view_.declarations[i]) &&
                         is_short(view_.declarations[i + 1]);
      view_.declarations[i].ends_group = !joins && !view_.declarations[i].is_early;
    }
  }

  const model::Definition& definition_;
  Names names_;
  Types types_;
  Context context_;
  DefinitionView view_;
};

}  // namespace

ModelView make_view(const model::Model& model, Report& report) {
  ModelView view;
  for (const auto& definition : model.definitions()) {
    if (definition->is_import) continue;
    check_types(*definition, report);
    view.definitions.push_back(DefinitionMaker(*definition, model, report).make());
  }
  return view;
}

}  // namespace robdef::cpp
