// SPDX-License-Identifier: Apache-2.0
// Model -> view: what is declared, and its help texts. Members are made in member_view.cpp. Reports
// R0901, R0903 and R0904, and what the C++ backend refuses, which makes the other half of a client.
#include "compiler/backends/matlab/view.hpp"

#include <algorithm>
#include <utility>
#include <variant>

#include "compiler/backends/check_values.hpp"
#include "compiler/backends/cpp/names.hpp"
#include "compiler/backends/matlab/constants.hpp"
#include "compiler/backends/matlab/names.hpp"
#include "compiler/backends/matlab/view_parts.hpp"
#include "compiler/backends/words.hpp"
#include "compiler/model/print.hpp"
#include "compiler/output/prose.hpp"

namespace robdef::matlab {
namespace {

constexpr std::size_t text_width = 90;

std::string upper(std::string_view name) {
  std::string result(name);
  for (char& c : result) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return result;
}

EnumView make_enum(const model::Enum& enumeration) {
  EnumView view;
  view.wire_name = enumeration.definition->name + "." + enumeration.name;
  view.name = type_name(code_name(enumeration));
  view.qualified = qualified(*enumeration.definition, view.name);
  Help text = help(view.name, enumeration.documentation, "The values of " + view.wire_name + ".");
  view.title = std::move(text.title);
  view.help = std::move(text.lines);
  view.has_values = !enumeration.values.empty();
  for (const model::EnumValue& value : enumeration.values) {
    view.values.push_back({.wire_name = value.name,
                           .name = member_name(code_name(value), view.name),
                           .doc = comment(value.documentation),
                           .value = "int32(" + std::to_string(value.value) + ")"});
  }
  return view;
}

ExceptionView make_exception(const model::Exception& exception) {
  const std::string& service = exception.definition->name;
  ExceptionView view;
  view.wire_name = service + "." + exception.name;
  view.name = exception_name(code_name(exception));
  // As the runtime does it: rr/matlab/identifier.hpp.
  view.identifier = view.wire_name;
  std::replace(view.identifier.begin(), view.identifier.end(), '.', ':');
  Help text = help(view.name, exception.documentation, "The exception " + view.wire_name + ".");
  view.title = std::move(text.title);
  view.help = std::move(text.lines);
  return view;
}

RecordView make_record(const model::Record& record) {
  const model::Definition& definition = *record.definition;
  RecordView view;
  describe(view, record);
  view.name = type_name(code_name(record));
  view.qualified = qualified(definition, view.name);
  view.cpp = cpp::qualified(definition, cpp::identifier(code_name(record)));
  Help text =
      help(view.name, record.documentation, "A value for the " + view.kind + " " + view.wire_name);
  view.title = std::move(text.title);
  view.help = std::move(text.lines);
  Report heard_elsewhere;  // by the C++ backend
  const cpp::RecordNames names(record, heard_elsewhere);
  for (const model::Field& field : record.fields) {
    FieldView one;
    one.wire_name = field.name;
    one.cpp_name = names.of(field.name);
    one.robdef_type = field.type.text();
    one.help = {"%   " + model::written(field, definition)};
    const std::vector<std::string> doc = prose(field.documentation, "%       ", text_width);
    one.help.insert(one.help.end(), doc.begin(), doc.end());
    view.fields.push_back(std::move(one));
  }
  view.constants = make_constants(record.constants, constants_class_of(record));
  view.has_constants = !view.constants.empty();
  view.constants_class = constants_class_of(record);
  return view;
}

std::vector<std::string> text_lines(std::string_view text) {
  std::vector<std::string> lines;
  for (const std::string_view line : lines_of(text)) lines.push_back(string_literal(line));
  return lines;
}

class DefinitionMaker {
 public:
  DefinitionMaker(const model::Definition& definition, Report& report)
      : definition_(definition), report_(report) {}

  DefinitionView make() {
    view_.wire_name = definition_.name;
    view_.definition_file = definition_.name + ".robdef";
    view_.package = package_of(definition_.name);
    view_.folder = folder_of(definition_.name);
    view_.path = cpp::path_of(definition_.name);
    view_.space = cpp::namespace_of(definition_.name);
    for (const model::Definition* import : definition_.imports) {
      view_.import_headers.push_back(cpp::path_of(import->name) + ".mex.hpp");
      view_.import_packages.push_back(package_of(import->name));
    }
    view_.text = text_lines(definition_.text);
    view_.constants = make_constants(definition_.constants, constants_class);
    view_.has_constants = !view_.constants.empty();
    for (const model::Declaration& declaration : definition_.declarations) {
      std::visit([&](const auto* declared) { make(*declared); }, declaration);
    }
    view_.has_objects = !definition_.objects.empty();
    return std::move(view_);
  }

 private:
  void make(const model::Constant& /*constant*/) {}
  void make(const model::Exception& exception) {
    view_.declarations.emplace_back().exception = make_exception(exception);
  }
  void make(const model::Enum& enumeration) {
    view_.declarations.emplace_back().enumeration = make_enum(enumeration);
  }
  void make(const model::Record& record) {
    view_.declarations.emplace_back().record = make_record(record);
  }
  void make(const model::Object& object) {
    view_.declarations.emplace_back().object = make_object(object, report_);
  }

  const model::Definition& definition_;
  Report& report_;
  DefinitionView view_;
};

}  // namespace

Help help(std::string_view name, const std::string& documentation, const std::string& title) {
  std::vector<std::string> lines =
      prose(documentation.empty() ? title : documentation, "%   ", text_width);
  Help result;
  // The first line goes on behind the name, and keeps the blank that was behind its mark.
  result.title = "%" + upper(name) + " " +
                 lines.front().substr(std::min<std::size_t>(4, lines.front().size()));
  lines.erase(lines.begin());
  result.lines = std::move(lines);
  return result;
}

std::vector<std::string> comment(const std::string& documentation) {
  if (documentation.empty()) return {};
  return prose(documentation, "% ", text_width);
}

std::vector<ConstantView> make_constants(const std::vector<model::Constant>& constants,
                                         std::string_view owner) {
  std::vector<ConstantView> views;
  for (const model::Constant& constant : constants) {
    // Refused by check_values.
    if (constant.type.container != model::ContainerForm::none) continue;
    views.push_back({.wire_name = constant.name,
                     .name = member_name(code_name(constant), owner),
                     .doc = comment(constant.documentation),
                     .value = constant_value(constant)});
  }
  return views;
}

ModelView make_view(const model::Model& model, Report& report) {
  ModelView view;
  view.client = client_of(model);
  for (const auto& definition : model.definitions()) {
    if (definition->is_import) continue;
    check_values(
        *definition,
        {.language = std::string(language), .judge = [](const model::Type&) { return ""; }},
        report);
    check_names(*definition, model, report);
    view.definitions.push_back(DefinitionMaker(*definition, report).make());
  }
  return view;
}

}  // namespace robdef::matlab
