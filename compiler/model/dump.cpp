// SPDX-License-Identifier: Apache-2.0
// Model -> JSON; the form is written down in dump.hpp.
#include "compiler/model/dump.hpp"

#include <cstdint>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "compiler/model/rename.hpp"
#include "compiler/output/json.hpp"
#include "compiler/syntax/parse.hpp"

namespace robdef::model {
namespace {

constexpr int model_version = 2;

std::string_view word_for(ArrayForm form) {
  switch (form) {
    case ArrayForm::none:
      return "none";
    case ArrayForm::any_length:
      return "any_length";
    case ArrayForm::fixed_length:
      return "fixed_length";
    case ArrayForm::maximum_length:
      return "maximum_length";
    case ArrayForm::any_shape:
      return "any_shape";
    case ArrayForm::fixed_shape:
      return "fixed_shape";
  }
  return "";
}

std::string_view word_for(ContainerForm form) {
  switch (form) {
    case ContainerForm::none:
      return "none";
    case ContainerForm::list:
      return "list";
    case ContainerForm::int32_map:
      return "int32";
    case ContainerForm::string_map:
      return "string";
    case ContainerForm::generator:
      return "generator";
  }
  return "";
}

std::string_view word_for(GeneratorForm form) {
  switch (form) {
    case GeneratorForm::none:
      return "none";
    case GeneratorForm::returns:
      return "returns";
    case GeneratorForm::takes:
      return "takes";
    case GeneratorForm::both:
      return "both";
  }
  return "";
}

std::string_view word_for(IndexForm form) {
  switch (form) {
    case IndexForm::none:
      return "none";
    case IndexForm::int32:
      return "int32";
    case IndexForm::string:
      return "string";
  }
  return "";
}

std::string_view word_for(ast::VersionSpelling spelling) {
  switch (spelling) {
    case ast::VersionSpelling::none:
      return "none";
    case ast::VersionSpelling::stdver:
      return "stdver";
    case ast::VersionSpelling::option:
      return "option";
  }
  return "";
}

struct BaseKind {
  std::string_view operator()(Primitive) const { return "primitive"; }
  std::string_view operator()(const Record* record) const { return model::name_of(record->kind); }
  std::string_view operator()(const Enum*) const { return "enum"; }
  std::string_view operator()(const Object*) const { return "object"; }
  std::string_view operator()(VarValue) const { return "varvalue"; }
  std::string_view operator()(VarObject) const { return "varobject"; }
  std::string_view operator()(Unknown) const { return "unknown"; }
};

class Dump {
 public:
  Dump(JsonWriter& json, const Sources& sources, Detail detail)
      : json_(json),
        sources_(sources),
        is_full_(detail == Detail::full),
        is_documented_(detail != Detail::shape) {}
  Dump(JsonWriter& json, const Sources& sources, const DumpAdditions& additions)
      : json_(json), sources_(sources), additions_(&additions) {}

  void definitions(const Model& model) {
    list("definitions", model.definitions(), [this](const auto& one) { definition(*one); });
  }

 private:
  template <class Items, class Write>
  void list(std::string_view key, const Items& items, Write write) {
    json_.key(key).begin_array();
    for (const auto& item : items) write(item);
    json_.end_array();
  }

  void texts(std::string_view key, const std::vector<std::string>& items) {
    list(key, items, [this](const std::string& text) { json_.value(text); });
  }

  /// Begins the object of something that can be renamed.
  template <class Named>
  void name(const Named& named) {
    json_.begin_object();
    name_only(named);
  }

  template <class Named>
  void name_only(const Named& named) {
    json_.member("name", named.name);
    if (additions_ != nullptr) json_.member("code_name", code_name(named));
  }

  template <class Write>
  void add(Write write) {
    if (additions_ != nullptr) write(*additions_);
  }

  void documentation(const std::string& text) {
    if (is_documented_) json_.member("documentation", text);
  }

  void offsets(std::uint32_t begin, std::uint32_t end) {
    json_.begin_array().value(begin).value(end).end_array();
  }

  /// Where programs find what the text has at `span`.
  void place_in_file(std::string_view key, Span span) {
    const Source& source = sources_[span.source];
    const Position position = source.position(span.begin);
    json_.key(key).begin_object().member("file", source.name());
    json_.member("line", position.line).member("column", position.column);
    json_.member("length", span.end - span.begin).end_object();
  }

  void place(std::string_view key, Span span) {
    if (!is_full_) return;
    if (additions_ != nullptr) {
      place_in_file(key == "span" ? "at" : "version_at", span);
      return;
    }
    json_.key(key);
    offsets(span.begin, span.end);
  }

  void origin(const std::string& text, Span span) {
    documentation(text);
    if (!is_full_) return;
    if (additions_ == nullptr)
      json_.member("line", sources_[span.source].position(span.begin).line);
    place("span", span);
  }

  void lines(const Definition& definition);

  void definition(const Definition& definition);
  void declarations(const Definition& definition);
  void constant(const Constant& constant);
  void enumeration(const Enum& enumeration);
  void record(const Record& record);
  void field(const Field& field);
  void object(const Object& object);
  void member(const Object& object, const Member& member);
  void parameter(const Parameter& parameter);
  void modifiers(const std::vector<Modifier>& modifiers);
  void access(const Access& access);
  void type(const Type& type);
  void records(std::string_view key, const Definition& definition, RecordKind kind);

  void constants(const std::vector<Constant>& constants) {
    list("constants", constants, [this](const Constant& one) { constant(one); });
  }

  JsonWriter& json_;
  const Sources& sources_;
  const bool is_full_ = true;
  const bool is_documented_ = true;
  const DumpAdditions* const additions_ = nullptr;
};

void Dump::definition(const Definition& definition) {
  const bool has_version = definition.version_spelling != ast::VersionSpelling::none;
  json_.begin_object().member("name", definition.name);
  if (is_full_) {
    json_.member("file", sources_[definition.source].name());
    json_.member("is_import", definition.is_import);
  }
  json_.member("version", has_version ? text_of(definition.version) : std::string());
  json_.member("version_spelling", word_for(definition.version_spelling));
  place("version_span", definition.version_span);
  documentation(definition.documentation);
  place("span", definition.span);
  list("imports", definition.imports, [this](const Definition* one) { json_.value(one->name); });
  list("aliases", definition.aliases, [this](const Alias& alias) {
    json_.begin_object().member("name", alias.name).member("of", alias.qualified_name);
    place("span", alias.span);
    json_.end_object();
  });
  texts("options", definition.options);
  constants(definition.constants);
  list("exceptions", definition.exceptions, [this](const Exception& exception) {
    name(exception);
    origin(exception.documentation, exception.span);
    add([&](const auto& more) { more.exception(json_, exception); });
    json_.end_object();
  });
  list("enums", definition.enums, [this](const Enum& one) { enumeration(one); });
  records("structs", definition, RecordKind::struct_);
  records("pods", definition, RecordKind::pod);
  records("namedarrays", definition, RecordKind::namedarray);
  list("objects", definition.objects, [this](const Object& one) { object(one); });
  if (is_documented_) declarations(definition);
  if (is_full_) {
    json_.member("text", definition.text);
    if (additions_ == nullptr) lines(definition);
  }
  json_.end_object();
}

// Read once more: models that are not printed need no room for them.
void Dump::lines(const Definition& definition) {
  Report unused;
  const ast::File file = ast::parse(sources_[definition.source], definition.source, unused);
  list("lines", file.written.lines, [this, &file](const ast::Line& line) {
    json_.begin_object().member("kind", ast::name_of(line.kind));
    json_.member("is_in_block", line.is_in_block).key("span");
    offsets(line.begin, line.end);
    list("tokens", file.written.tokens_of(line), [this](const ast::Token& token) {
      json_.begin_object().member("kind", ast::name_of(token.kind)).key("span");
      offsets(token.begin, token.end);
      json_.end_object();
    });
    json_.end_object();
  });
}

void Dump::declarations(const Definition& definition) {
  list("declarations", definition.declarations, [this](const Declaration& declaration) {
    std::visit([this](const auto* item) { json_.value(item->name); }, declaration);
  });
}

void Dump::constant(const Constant& constant) {
  name(constant);
  json_.member("type", constant.is_struct ? std::string("struct") : constant.type.text());
  if (additions_ != nullptr) {
    json_.key("value_type");
    if (constant.is_struct) {
      json_.null();
    } else {
      type(constant.type);
    }
  }
  json_.key("value");
  const auto number = [this](const Number& value) {
    std::visit([this](auto exact) { json_.value(exact); }, value);
  };
  if (const auto* one = std::get_if<Number>(&constant.value)) {
    number(*one);
  } else if (const auto* text = std::get_if<std::string>(&constant.value)) {
    json_.value(*text);
  } else if (const auto* numbers = std::get_if<std::vector<Number>>(&constant.value)) {
    json_.begin_array();
    for (const Number& value : *numbers) number(value);
    json_.end_array();
  } else {
    json_.begin_array();
    for (const auto& field : std::get<std::vector<StructValueField>>(constant.value)) {
      json_.begin_object().member("field", field.field);
      json_.member("constant", field.constant->name);
      place("span", field.span);
      json_.end_object();
    }
    json_.end_array();
  }
  origin(constant.documentation, constant.span);
  json_.end_object();
}

void Dump::enumeration(const Enum& enumeration) {
  name(enumeration);
  list("values", enumeration.values, [this](const EnumValue& value) {
    name(value);
    json_.member("value", value.value);
    json_.member("is_hexadecimal", value.is_hexadecimal);
    documentation(value.documentation);
    place("span", value.span);
    json_.end_object();
  });
  origin(enumeration.documentation, enumeration.span);
  add([&](const auto& more) { more.enumeration(json_, enumeration); });
  json_.end_object();
}

void Dump::records(std::string_view key, const Definition& definition, RecordKind kind) {
  list(key, definition.records, [this, kind](const Record& one) {
    if (one.kind == kind) record(one);
  });
}

void Dump::record(const Record& record) {
  name(record);
  constants(record.constants);
  list("fields", record.fields, [this](const Field& one) { field(one); });
  texts("options", record.options);
  switch (record.kind) {
    case RecordKind::struct_:
      json_.member("is_recursive", record.is_recursive);
      break;
    case RecordKind::pod:
      json_.member("packed_size", record.packed_size);
      break;
    case RecordKind::namedarray:
      json_.member("number", model::name_of(record.number));
      json_.member("number_count", record.number_count);
      break;
  }
  origin(record.documentation, record.span);
  add([&](const auto& more) { more.record(json_, record); });
  json_.end_object();
}

void Dump::field(const Field& field) {
  name(field);
  json_.key("type");
  type(field.type);
  modifiers(field.modifiers);
  origin(field.documentation, field.span);
  json_.end_object();
}

void Dump::object(const Object& object) {
  name(object);
  list("implements", object.implements,
       [this](const Object* one) { json_.value(one->qualified_name()); });
  constants(object.constants);
  list("members", object.members, [&](const Member& one) { member(object, one); });
  texts("options", object.options);
  origin(object.documentation, object.span);
  add([&](const auto& more) { more.object(json_, object); });
  json_.end_object();
}

void Dump::member(const Object& object, const Member& member) {
  json_.begin_object().member("kind", model::name_of(member.kind));
  name_only(member);
  json_.key("type");
  type(member.type);
  json_.member("index", word_for(member.index));
  list("parameters", member.parameters, [this](const Parameter& one) { parameter(one); });
  json_.member("generator", word_for(member.generator)).key("generator_parameter");
  if (member.generator_parameter) {
    parameter(*member.generator_parameter);
  } else {
    json_.null();
  }
  modifiers(member.modifiers);
  access(member.access);
  origin(member.documentation, member.span);
  add([&](const auto& more) { more.member(json_, object, member); });
  json_.end_object();
}

void Dump::parameter(const Parameter& parameter) {
  name(parameter);
  json_.key("type");
  type(parameter.type);
  place("span", parameter.span);
  json_.end_object();
}

void Dump::modifiers(const std::vector<Modifier>& modifiers) {
  list("modifiers", modifiers, [this](const Modifier& modifier) {
    json_.begin_object().member("name", modifier.name);
    texts("arguments", modifier.arguments);
    place("span", modifier.span);
    json_.end_object();
  });
}

void Dump::access(const Access& access) {
  const std::pair<bool, std::string_view> words[] = {
      {access.is_readonly, "readonly"},     {access.is_writeonly, "writeonly"},
      {access.is_unreliable, "unreliable"}, {access.is_nolock, "nolock"},
      {access.is_nolockread, "nolockread"}, {access.is_perclient, "perclient"},
      {access.is_urgent, "urgent"},
  };
  list("access", words, [this](const auto& word) {
    if (word.first) json_.value(word.second);
  });
}

void Dump::type(const Type& type) {
  Type base = type;
  base.array = ArrayForm::none;
  base.container = ContainerForm::none;
  json_.begin_object().member("text", type.text());
  json_.member("kind", std::visit(BaseKind{}, type.base)).member("name", base.text());
  json_.member("array", word_for(type.array)).key("dimensions").begin_array();
  for (const std::uint32_t dimension : type.dimensions) json_.value(dimension);
  json_.end_array().member("container", word_for(type.container));
  place("span", type.span);
  add([&](const auto& more) { more.type(json_, type); });
  json_.end_object();
}

}  // namespace

std::string dump(const Model& model, const Sources& sources, Detail detail) {
  JsonWriter json;
  json.begin_object().member("model_version", model_version);
  Dump(json, sources, detail).definitions(model);
  json.end_object();
  return std::move(json).text();
}

void dump_definitions(JsonWriter& json, const Model& model, const Sources& sources,
                      const DumpAdditions& additions) {
  Dump(json, sources, additions).definitions(model);
}

}  // namespace robdef::model
