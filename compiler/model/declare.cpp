// SPDX-License-Identifier: Apache-2.0
// Makes a definition of a file, with everything that has a name and nothing that has to be looked
// up. Reports nothing.
#include "compiler/model/declare.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

namespace robdef::model {
namespace {

bool encloses(Span outer, Span inner) {
  return outer.source == inner.source && outer.begin <= inner.begin && inner.end <= outer.end;
}

// Texts of the options that did not become a version or a constant.
std::vector<std::string> kept_options(const std::vector<ast::Option>& options) {
  std::vector<std::string> kept;
  for (const ast::Option& option : options) {
    const std::vector<std::string_view> words = words_of(option.text);
    const bool is_read = !words.empty() && (words[0] == "version" || words[0] == "constant");
    if (!is_read) kept.push_back(option.text);
  }
  return kept;
}

Constant declared(const ast::Constant& written, const std::vector<ast::Option>& options) {
  Constant constant;
  constant.name = written.name.text;
  constant.span = written.name.span;
  constant.documentation = written.documentation;
  constant.written = written.value;
  const std::optional<Primitive> primitive = primitive_of(written.type.base.text);
  constant.is_struct = !primitive;
  constant.type = {primitive ? Base{*primitive} : Base{Unknown{}}, written.type.array,
                   written.type.dimensions, written.type.container, written.type.span};
  constant.is_option = std::any_of(
      options.begin(), options.end(),
      [&written](const ast::Option& option) { return encloses(option.span, written.name.span); });
  return constant;
}

std::vector<Constant> declared(const std::vector<ast::Constant>& written,
                               const std::vector<ast::Option>& options) {
  std::vector<Constant> constants;
  constants.reserve(written.size());
  for (const ast::Constant& constant : written) constants.push_back(declared(constant, options));
  return constants;
}

Exception declared(const ast::Exception& written, const Definition& definition) {
  return {written.name.text, &definition, written.documentation, written.name.span};
}

Enum declared(const ast::Enum& written, const Definition& definition) {
  Enum enumeration{written.name.text, &definition, {}, written.documentation, written.name.span};
  for (const ast::EnumValue& value : written.values) {
    enumeration.values.push_back(
        {value.name.text, 0, false, value.value, value.documentation, value.name.span});
  }
  return enumeration;
}

Record declared(const ast::Record& written, const Definition& definition) {
  Record record;
  record.kind = written.kind;
  record.name = written.name.text;
  record.definition = &definition;
  record.constants = declared(written.constants, written.options);
  record.options = kept_options(written.options);
  record.documentation = written.documentation;
  record.span = written.name.span;
  return record;
}

Object declared(const ast::Object& written, const Definition& definition) {
  Object object;
  object.name = written.name.text;
  object.definition = &definition;
  object.constants = declared(written.constants, written.options);
  object.options = kept_options(written.options);
  object.documentation = written.documentation;
  object.span = written.name.span;
  return object;
}

// Makes room first: declarations point into the lists.
void reserve_declarations(const ast::File& file, Definition& definition) {
  const auto count = [&file]<class Kind>(const Kind& /*any*/) {
    return static_cast<std::size_t>(std::count_if(
        file.declarations.begin(), file.declarations.end(),
        [](const ast::Declaration& written) { return std::holds_alternative<Kind>(written); }));
  };
  definition.constants.reserve(count(ast::Constant{}));
  definition.exceptions.reserve(count(ast::Exception{}));
  definition.enums.reserve(count(ast::Enum{}));
  definition.records.reserve(count(ast::Record{}));
  definition.objects.reserve(count(ast::Object{}));
  definition.declarations.reserve(file.declarations.size());
}

struct Declare {
  const ast::File& file;
  Definition& definition;

  void operator()(const ast::Constant& written) const {
    definition.declarations.emplace_back(
        &definition.constants.emplace_back(declared(written, file.options)));
  }
  void operator()(const ast::Exception& written) const {
    definition.declarations.emplace_back(
        &definition.exceptions.emplace_back(declared(written, definition)));
  }
  void operator()(const ast::Enum& written) const {
    definition.declarations.emplace_back(
        &definition.enums.emplace_back(declared(written, definition)));
  }
  void operator()(const ast::Record& written) const {
    definition.declarations.emplace_back(
        &definition.records.emplace_back(declared(written, definition)));
  }
  void operator()(const ast::Object& written) const {
    definition.declarations.emplace_back(
        &definition.objects.emplace_back(declared(written, definition)));
  }
};

}  // namespace

std::vector<std::string_view> words_of(std::string_view text) {
  constexpr std::string_view blanks = " \t";
  std::vector<std::string_view> words;
  for (std::size_t at = text.find_first_not_of(blanks); at != text.npos;) {
    const std::size_t end = std::min(text.find_first_of(blanks, at), text.size());
    words.push_back(text.substr(at, end - at));
    at = text.find_first_not_of(blanks, end);
  }
  return words;
}

Definition& declare(const ast::ProgramFile& written, const Source& source, Model& model) {
  const ast::File& file = written.file;
  Definition& definition = model.add(file.service ? file.service->text : std::string());
  definition.source = file.source;
  definition.is_import = written.is_import;
  definition.text = source.text();
  definition.documentation = file.documentation;
  definition.version_spelling = file.version_spelling;
  definition.version = file.version;
  definition.version_span = file.version_span;
  definition.options = kept_options(file.options);
  definition.span = file.service ? file.service->span : Span{file.source, 0, 0};
  reserve_declarations(file, definition);
  for (const ast::Declaration& declaration : file.declarations) {
    std::visit(Declare{file, definition}, declaration);
  }
  return definition;
}

}  // namespace robdef::model
