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
#include "compiler/backends/words.hpp"
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

std::string variable(const CppType& type, const std::string& name, std::size_t indent) {
  const std::string flat = type.text + " " + name + type.initial + ";";
  if (indent + flat.size() <= line_width) return flat;
  if (type.initial.starts_with(" = ") &&
      indent + type.text.size() + 1 + name.size() + 2 <= line_width) {
    return assignment(type.text + " " + name, type.initial.substr(3), indent);
  }
  return type.text + "\n" + std::string(indent + 4, ' ') + name + type.initial + ";";
}

namespace {

/// Throws the exception's class: a row of the definition's table.
std::string exception_row(const ExceptionView& view, const Names& names) {
  std::set<std::string> taken;
  const std::string error = names.local("error", taken);
  const std::string raise =
      "[](const ::rr::Error& " + error + ") { throw " + view.name + "(" + error + "); }";
  return list({.before = "{", .items = {"\"" + view.wire_name + "\"", raise}, .after = "},"}, 4);
}

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
    make_tables();
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
    std::vector<std::string> numbers;
    for (const std::uint32_t number : definition_.version.numbers) {
      numbers.push_back(std::to_string(number));
    }
    view_.version = "{" + join(numbers, ", ") + "}";
  }

  void make_imports() {
    for (const model::Definition* import : definition_.imports) {
      const std::string header = path_of(import->name) + ".hpp";
      view_.imports.push_back({.wire_name = import->name,
                               .header = header,
                               .definition = qualified(*import, "rr_definition")});
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
        view_.aliases.push_back({"using " + identifier(alias.name) + " = " +
                                 qualified(*import, identifier(name)) + ";"});
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
      view_.forwards.push_back({"struct " + identifier(code_name(**record)) + ";"});
    } else if (const auto* object = std::get_if<const model::Object*>(&early)) {
      view_.forwards.push_back({"class " + stub_name(**object) + ";"});
      view_.forwards.push_back({"class " + skeleton_name(**object) + ";"});
    }
  }

  DeclarationView make(const model::Constant& constant) {
    DeclarationView view;
    view.constant = make_constant(constant, "inline constexpr", 0, context_);
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

  void make_tables() {
    std::vector<std::string> imports;
    std::vector<std::string> records;
    std::vector<std::string> exceptions;
    std::vector<std::string> objects;
    for (const ImportView& import : view_.imports) imports.push_back("&" + import.definition + ",");
    for (const DeclarationView& view : view_.declarations) {
      if (view.record) records.push_back("&" + view.record->table + ",");
      if (view.exception) exceptions.push_back(exception_row(*view.exception, names_));
      if (view.object) objects.push_back("&" + view.object->table + ",");
    }
    view_.import_rows = table_rows(imports, 4);
    view_.record_rows = table_rows(records, 4);
    view_.exception_rows = table_rows(exceptions, 4);
    view_.object_rows = table_rows(objects, 4);
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
