// SPDX-License-Identifier: Apache-2.0
// Model -> view: what is declared, in which order. Members are made in member_view.cpp. Reports
// R0901 to R0904.
#include "compiler/backends/typescript/view.hpp"

#include <string_view>
#include <utility>
#include <variant>

#include "compiler/backends/check_values.hpp"
#include "compiler/backends/literals.hpp"
#include "compiler/backends/typescript/constants.hpp"
#include "compiler/backends/typescript/view_parts.hpp"
#include "compiler/backends/words.hpp"
#include "compiler/output/prose.hpp"

namespace robdef::typescript {
namespace {

constexpr std::size_t line_width = 120;
/// Items that a typed array can have.
constexpr std::uint64_t most_items = (std::uint64_t{1} << 32) - 1;

void check_types(const model::Definition& definition, Report& report) {
  const auto judge = [](const model::Type& type) -> std::string {
    const bool is_any =
        type.array == model::ArrayForm::any_length || type.array == model::ArrayForm::any_shape;
    return !is_any && type.element_count() > most_items ? "an array of more than 4294967295 items"
                                                        : "";
  };
  check_values(definition, {.language = "TypeScript", .judge = judge}, report);
}

EnumView make_enum(const model::Enum& enumeration, Report& report) {
  EnumView view;
  view.wire_name = enumeration.name;
  view.name = exported(code_name(enumeration));
  view.doc = comment(enumeration.documentation, 0);
  NameSet names(typescript_language, report);
  for (const model::EnumValue& value : enumeration.values) {
    names.add(code_name(value), value.span, "value",
              enumeration.definition->name + "." + enumeration.name + "." + value.name);
    view.values.push_back({.wire_name = value.name,
                           .name = code_name(value),
                           .value = enum_literal(value),
                           .doc = comment(value.documentation, 2)});
  }
  view.has_values = !view.values.empty();
  return view;
}

ExceptionView make_exception(const model::Exception& exception) {
  return {.wire_name = exception.definition->name + "." + exception.name,
          .short_name = exception.name,
          .name = exported(code_name(exception)),
          .doc = comment(exception.documentation, 0)};
}

RecordView make_record(const model::Record& record, const Context& context) {
  RecordView view;
  describe(view, record);
  view.name = exported(code_name(record));
  view.doc = comment(record.documentation, 0);
  if (view.is_namedarray) view.number_row = context.types.row(record.number);
  view.constants_name = constants_name(code_name(record));
  view.constants = make_constants(record.constants, 2, record.qualified_name(), context.report);
  view.has_constants = !view.constants.empty();
  for (const model::Field& field : record.fields) {
    refuse_rename(field.name, code_name(field), "field", typescript_language, field.span,
                  context.report);
    view.fields.push_back({.wire_name = field.name,
                           .doc = comment(field.documentation, 2),
                           .type = context.types.spell(field.type).text,
                           .robdef_type = field.type.text()});
  }
  return view;
}

class DefinitionMaker {
 public:
  DefinitionMaker(const model::Definition& definition, Report& report)
      : definition_(definition),
        names_(definition, report),
        types_(names_),
        context_{names_, types_, report} {}

  DefinitionView make() {
    view_.wire_name = definition_.name;
    view_.doc = comment(definition_.documentation, 0);
    make_imports();
    view_.constants = make_constants(definition_.constants, 0, definition_.name, context_.report);
    for (const model::Declaration& declaration : definition_.declarations) {
      std::visit([&](const auto* declared) { make(*declared); }, declaration);
    }
    view_.has_exceptions = !definition_.exceptions.empty();
    view_.promise = names_.global("Promise");
    view_.text = unicode_literal_lines(definition_.text);
    return std::move(view_);
  }

 private:
  void make_imports() {
    std::vector<std::string> modules;
    for (const model::Definition* import : definition_.imports) {
      const std::string& alias = names_.alias(*import);
      view_.imports.push_back({.wire_name = import->name, .alias = alias});
      modules.push_back(alias + ".rr_module");
    }
    view_.import_modules = join(modules, ", ");
  }

  void make(const model::Constant& /*constant*/) {}
  void make(const model::Exception& exception) {
    view_.declarations.emplace_back().exception = make_exception(exception);
  }
  void make(const model::Enum& enumeration) {
    view_.declarations.emplace_back().enumeration = make_enum(enumeration, context_.report);
  }
  void make(const model::Record& record) {
    view_.declarations.emplace_back().record = make_record(record, context_);
  }
  void make(const model::Object& object) {
    view_.declarations.emplace_back().object = make_object(object, context_);
  }

  const model::Definition& definition_;
  Names names_;
  Types types_;
  Context context_;
  DefinitionView view_;
};

}  // namespace

std::vector<std::string> comment(const std::string& documentation, std::size_t indent) {
  if (documentation.empty()) return {};
  const std::string text = replace_all(documentation, "*/", "*\\/");
  std::vector<std::string> lines = prose(text, " * ", line_width - indent);
  if (lines.size() == 1) return {"/**" + lines.front().substr(2) + " */"};
  lines.insert(lines.begin(), "/**");
  lines.emplace_back(" */");
  return lines;
}

std::vector<ConstantView> make_constants(const std::vector<model::Constant>& constants,
                                         std::size_t indent, const std::string& owner,
                                         Report& report) {
  std::vector<ConstantView> views;
  NameSet names(typescript_language, report);
  for (const model::Constant& constant : constants) {
    const std::string name = exported(code_name(constant));
    names.add(code_name(constant), constant.span, "constant", owner + "." + constant.name);
    views.push_back({.wire_name = constant.name,
                     .name = name,
                     .key = code_name(constant),
                     .doc = comment(constant.documentation, indent),
                     .value = constant_value(constant, indent),
                     .definition = constant_definition(constant, name)});
  }
  return views;
}

ModelView make_view(const model::Model& model, Report& report) {
  ModelView view;
  for (const auto& definition : model.definitions()) {
    if (definition->is_import) continue;
    check_types(*definition, report);
    view.definitions.push_back(DefinitionMaker(*definition, report).make());
  }
  return view;
}

}  // namespace robdef::typescript
