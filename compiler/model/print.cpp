// SPDX-License-Identifier: Apache-2.0
// Model -> the text of a definition in its one printed form.
#include "compiler/model/print.hpp"

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <variant>
#include <vector>

namespace robdef::model {
namespace {

constexpr std::string_view indentation = "    ";
constexpr ast::Version without_options{{0, 9, 2, 0}};

// The name of a declaration as another file, or its own, has to write it.
std::string name_in(const Definition& file, const Definition& owner, const std::string& name) {
  if (&owner == &file) return name;
  std::string qualified = owner.name + '.' + name;
  for (const Alias& alias : file.aliases) {
    if (alias.qualified_name == qualified) return alias.name;
  }
  return qualified;
}

struct BaseIn {
  const Definition& file;

  std::string operator()(Primitive primitive) const { return std::string(name_of(primitive)); }
  std::string operator()(const Record* record) const {
    return name_in(file, *record->definition, record->name);
  }
  std::string operator()(const Enum* enumeration) const {
    return name_in(file, *enumeration->definition, enumeration->name);
  }
  std::string operator()(const Object* object) const {
    return name_in(file, *object->definition, object->name);
  }
  std::string operator()(VarValue) const { return "varvalue"; }
  std::string operator()(VarObject) const { return "varobject"; }
  std::string operator()(Unknown) const { return "unknown"; }
};

std::string modifiers_text(const std::vector<Modifier>& modifiers) {
  if (modifiers.empty()) return "";
  std::string text;
  for (const Modifier& modifier : modifiers) {
    text += text.empty() ? " [" : ", ";
    text += modifier.name;
    for (std::size_t i = 0; i < modifier.arguments.size(); ++i) {
      text += (i == 0 ? "(" : ", ") + modifier.arguments[i];
    }
    if (!modifier.arguments.empty()) text += ')';
  }
  return text + ']';
}

std::string parameter_text(const Parameter& parameter, std::string_view container,
                           const Definition& file) {
  return written(parameter.type, file) + std::string(container) + ' ' + parameter.name;
}

std::string parameters_text(const Member& member, const Definition& file) {
  std::string text;
  for (const Parameter& parameter : member.parameters) {
    text += text.empty() ? "" : ", ";
    text += parameter_text(parameter, "", file);
  }
  if (member.generator_parameter) {
    text += text.empty() ? "" : ", ";
    text += parameter_text(*member.generator_parameter, text_of(ContainerForm::generator), file);
  }
  return '(' + text + ')';
}

std::string type_text(const Member& member, const Definition& file) {
  std::string text = written(member.type, file);
  const bool returns =
      member.generator == GeneratorForm::returns || member.generator == GeneratorForm::both;
  if (returns) text += text_of(ContainerForm::generator);
  if (member.index == IndexForm::int32) text += text_of(ContainerForm::int32_map);
  if (member.index == IndexForm::string) text += text_of(ContainerForm::string_map);
  return text;
}

void append_unit(std::string& text, std::uint32_t unit) {
  constexpr std::string_view hex = "0123456789abcdef";
  text += "\\u";
  for (int shift = 12; shift >= 0; shift -= 4) text += hex[(unit >> shift) & 15];
}

// The code point at `at`, which is moved behind it. The text is valid UTF-8: it came from escapes.
std::uint32_t next_code_point(std::string_view text, std::size_t& at) {
  const auto byte = [&] { return static_cast<unsigned char>(text[at++]); };
  const std::uint32_t lead = byte();
  if (lead < 0x80) return lead;
  const int more = lead >= 0xF0 ? 3 : lead >= 0xE0 ? 2 : 1;
  std::uint32_t point = lead & (0x3Fu >> more);
  for (int i = 0; i < more && at < text.size(); ++i) point = (point << 6) | (byte() & 0x3Fu);
  return point;
}

// A definition is ASCII, so all else becomes escapes of UTF-16 units.
std::string string_text(std::string_view value) {
  std::string text = "\"";
  for (std::size_t at = 0; at < value.size();) {
    const std::uint32_t point = next_code_point(value, at);
    if (point == '"' || point == '\\') {
      text += '\\';
      text += static_cast<char>(point);
    } else if (point == '\n') {
      text += "\\n";
    } else if (point == '\t') {
      text += "\\t";
    } else if (point >= 0x20 && point < 0x7F) {
      text += static_cast<char>(point);
    } else if (point < 0x10000) {
      append_unit(text, point);
    } else {
      append_unit(text, 0xD800 + ((point - 0x10000) >> 10));
      append_unit(text, 0xDC00 + ((point - 0x10000) & 0x3FF));
    }
  }
  return text + '"';
}

struct LiteralText {
  std::string operator()(const ast::NumberLiteral& literal) const { return literal.text; }
  std::string operator()(const ast::StringLiteral& literal) const {
    return string_text(literal.value);
  }
  std::string operator()(const ast::ArrayLiteral& literal) const {
    std::string text;
    for (const ast::NumberLiteral& item : literal.items) {
      text += (text.empty() ? "" : ", ") + item.text;
    }
    return '{' + text + '}';
  }
  std::string operator()(const ast::StructLiteral& literal) const {
    std::string text;
    for (const ast::StructLiteralField& field : literal.fields) {
      text += (text.empty() ? "" : ", ") + field.field.text + ": " + field.constant.text;
    }
    return '{' + text + '}';
  }
};

// Within int32, so -0x80000000 is the smallest.
std::string number_text(const EnumValue& value) {
  if (!value.is_hexadecimal) return std::to_string(value.value);
  const std::int64_t wide = value.value;
  char digits[16];
  const auto end = std::to_chars(digits, digits + sizeof digits, wide < 0 ? -wide : wide, 16).ptr;
  return (wide < 0 ? "-0x" : "0x") + std::string(digits, end);
}

// One definition, line by line.
class Printer {
 public:
  explicit Printer(const Definition& definition) : definition_(definition) {}

  std::string run() {
    line("service " + definition_.name);
    // A file of 0.9.2 or later can have options only before its version line (Q02).
    if (bans_options()) print_options("", definition_.options);
    print_version();
    for (const Definition* import : definition_.imports) line("import " + import->name);
    for (const Alias& alias : definition_.aliases) print_alias(alias);
    if (!bans_options()) print_options("", definition_.options);
    print_constants("", definition_.constants);
    for (const Enum& enumeration : definition_.enums) print_enum(enumeration);
    for (const Exception& exception : definition_.exceptions) line("exception " + exception.name);
    for (const RecordKind kind : {RecordKind::struct_, RecordKind::pod, RecordKind::namedarray}) {
      for (const Record& record : definition_.records) {
        if (record.kind == kind) print_record(record);
      }
    }
    for (const Object& object : definition_.objects) print_object(object);
    return std::move(text_);
  }

 private:
  [[nodiscard]] bool bans_options() const {
    return definition_.version_spelling == ast::VersionSpelling::stdver &&
           definition_.version >= without_options;
  }

  void line(const std::string& content) { text_ += content + '\n'; }
  void indented(const std::string& content) { line(std::string(indentation) + content); }

  void print_version() {
    if (definition_.version_spelling == ast::VersionSpelling::none) return;
    const bool is_option = definition_.version_spelling == ast::VersionSpelling::option;
    line((is_option ? "option version " : "stdver ") + text_of(definition_.version));
  }

  void print_alias(const Alias& alias) {
    const bool is_short = alias.qualified_name.ends_with('.' + alias.name);
    line("using " + alias.qualified_name + (is_short ? "" : " as " + alias.name));
  }

  void print_options(std::string_view indent, const std::vector<std::string>& options) {
    for (const std::string& option : options) line(std::string(indent) + "option " + option);
  }

  void print_constants(std::string_view indent, const std::vector<Constant>& constants) {
    for (const Constant& constant : constants) {
      const bool is_option = constant.is_option && !bans_options();
      line(std::string(indent) + (is_option ? "option " : "") + written(constant));
    }
  }

  void print_enum(const Enum& enumeration) {
    line("enum " + enumeration.name);
    for (std::size_t i = 0; i < enumeration.values.size(); ++i) {
      const EnumValue& value = enumeration.values[i];
      const bool is_last = i + 1 == enumeration.values.size();
      indented(value.name + " = " + number_text(value) + (is_last ? "" : ","));
    }
    line("end");
  }

  void print_record(const Record& record) {
    line(std::string(name_of(record.kind)) + ' ' + record.name);
    print_options(indentation, record.options);
    print_constants(indentation, record.constants);
    for (const Field& field : record.fields) indented(written(field, definition_));
    line("end");
  }

  void print_object(const Object& object) {
    line("object " + object.name);
    print_options(indentation, object.options);
    for (const Object* base : object.implements) {
      indented("implements " + written(*base, definition_));
    }
    print_constants(indentation, object.constants);
    for (const Member& member : object.members) indented(written(member, definition_));
    line("end");
  }

  const Definition& definition_;
  std::string text_;
};

}  // namespace

std::string print(const Definition& definition) { return Printer(definition).run(); }

std::string written_base(const Type& type, const Definition& file) {
  return std::visit(BaseIn{file}, type.base);
}

std::string written(const Type& type, const Definition& file) {
  return written_base(type, file) + type.suffix();
}

std::string written(const Member& member, const Definition& file) {
  std::string text(name_of(member.kind));
  if (member.kind != MemberKind::event) text += ' ' + type_text(member, file);
  text += ' ' + member.name;
  const bool has_parameters = member.kind == MemberKind::function ||
                              member.kind == MemberKind::event ||
                              member.kind == MemberKind::callback;
  if (has_parameters) text += parameters_text(member, file);
  return text + modifiers_text(member.modifiers);
}

std::string written(const Field& field, const Definition& file) {
  return "field " + written(field.type, file) + ' ' + field.name + modifiers_text(field.modifiers);
}

std::string written(const Constant& constant) {
  const std::string type = constant.is_struct ? "struct" : constant.type.text();
  return "constant " + type + ' ' + constant.name + ' ' + written_value(constant);
}

std::string written_value(const Constant& constant) {
  return std::visit(LiteralText{}, constant.written);
}

std::string written(const Object& object, const Definition& file) {
  return name_in(file, *object.definition, object.name);
}

}  // namespace robdef::model
