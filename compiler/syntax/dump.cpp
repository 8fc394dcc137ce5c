// SPDX-License-Identifier: Apache-2.0
#include "compiler/syntax/dump.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>
#include <utility>

#include "compiler/output/json.hpp"

namespace robdef::ast {
namespace {

constexpr std::array<std::string_view, 8> member_words = {
    "property", "function", "event", "objref", "pipe", "callback", "wire", "memory"};
constexpr std::array<std::string_view, 3> record_words = {"struct", "pod", "namedarray"};
constexpr std::array<std::string_view, 5> container_words = {"", "{list}", "{int32}", "{string}",
                                                             "{generator}"};

template <std::size_t size, class Enumeration>
std::string_view word(const std::array<std::string_view, size>& words, Enumeration value) {
  return words[static_cast<std::size_t>(value)];
}

class Dump {
 public:
  explicit Dump(const Source& source) : source_(source) {}

  std::string run(const File& file) {
    line(0, "file", "");
    if (file.service) line(1, "service", at(*file.service));
    documentation(2, file.documentation);
    if (file.version_spelling != VersionSpelling::none) {
      const bool is_stdver = file.version_spelling == VersionSpelling::stdver;
      line(1, is_stdver ? "stdver" : "option version",
           fmt::format("{} {}", fmt::join(file.version.numbers, "."), place(file.version_span)));
    }
    for (const Import& import : file.imports) line(1, "import", at(import.name));
    for (const Using& written : file.usings) {
      line(1, "using", at(written.qualified));
      if (written.alias) line(2, "as", at(*written.alias));
    }
    options(1, file.options);
    for (const Declaration& declaration : file.declarations) {
      std::visit([this](const auto& node) { show(node); }, declaration);
    }
    return std::move(text_);
  }

 private:
  void line(std::size_t depth, std::string_view what, std::string_view detail) {
    fmt::format_to(std::back_inserter(text_), "{:{}}{}{}{}\n", "", depth * 2, what,
                   detail.empty() ? "" : " ", detail);
  }

  [[nodiscard]] std::string place(Span span) const {
    const Position begin = source_.position(span.begin);
    const Position end = source_.position(span.end);
    if (begin.line == end.line) {
      return fmt::format("@{}:{}-{}", begin.line, begin.column, end.column);
    }
    return fmt::format("@{}:{}-{}:{}", begin.line, begin.column, end.line, end.column);
  }

  [[nodiscard]] std::string at(const Name& name) const {
    return fmt::format("{} {}", name.text, place(name.span));
  }

  void documentation(std::size_t depth, const Documentation& text) {
    if (text.empty()) return;
    for (std::size_t begin = 0; begin <= text.size();) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      line(depth, "##", std::string_view(text).substr(begin, end - begin));
      begin = end + 1;
    }
  }

  void options(std::size_t depth, const std::vector<Option>& options) {
    for (const Option& option : options) {
      line(depth, "option", fmt::format("{} {}", option.text, place(option.span)));
    }
  }

  [[nodiscard]] std::string type(const TypeRef& type) const {
    std::string array;
    const std::string dimensions = fmt::format("{}", fmt::join(type.dimensions, ","));
    switch (type.array) {
      case ArrayForm::none:
        break;
      case ArrayForm::any_length:
        array = "[]";
        break;
      case ArrayForm::fixed_length:
        array = fmt::format("[{}]", dimensions);
        break;
      case ArrayForm::maximum_length:
        array = fmt::format("[{}-]", dimensions);
        break;
      case ArrayForm::any_shape:
        array = "[*]";
        break;
      case ArrayForm::fixed_shape:
        array = fmt::format("[{}{}]", dimensions, type.dimensions.size() == 1 ? "," : "");
        break;
    }
    std::string result = fmt::format("type {}", at(type.base));
    if (!array.empty()) result += fmt::format(" {} {}", array, place(type.array_span));
    if (type.container != ContainerForm::none) {
      result +=
          fmt::format(" {} {}", word(container_words, type.container), place(type.container_span));
    }
    return result + fmt::format(" of {}", place(type.span));
  }

  void modifiers(std::size_t depth, const std::vector<Modifier>& modifiers) {
    for (const Modifier& modifier : modifiers) {
      line(depth, "modifier", fmt::format("{} of {}", at(modifier.name), place(modifier.span)));
      for (const ModifierArgument& argument : modifier.arguments) {
        line(depth + 1, argument.is_name ? "name" : "number",
             fmt::format("{} {}", argument.text, place(argument.span)));
      }
    }
  }

  void number(std::size_t depth, const NumberLiteral& literal) {
    line(depth, "number", fmt::format("{} {}", literal.text, place(literal.span)));
  }

  void value(std::size_t depth, const ConstantValue& value) {
    if (const auto* const literal = std::get_if<NumberLiteral>(&value)) {
      number(depth, *literal);
    } else if (const auto* const string = std::get_if<StringLiteral>(&value)) {
      line(depth, "string", fmt::format("{} {}", json_string(string->value), place(string->span)));
    } else if (const auto* const array = std::get_if<ArrayLiteral>(&value)) {
      line(depth, "array", place(array->span));
      for (const NumberLiteral& item : array->items) number(depth + 1, item);
    } else if (const auto* const fields = std::get_if<StructLiteral>(&value)) {
      line(depth, "fields", place(fields->span));
      for (const StructLiteralField& field : fields->fields) {
        line(depth + 1, "field", fmt::format("{}: {}", at(field.field), at(field.constant)));
      }
    }
  }

  void show(const Constant& constant, std::size_t depth = 1) {
    line(depth, "constant", at(constant.name));
    documentation(depth + 1, constant.documentation);
    line(depth + 1, type(constant.type), "");
    value(depth + 1, constant.value);
  }

  void show(const Exception& exception) {
    line(1, "exception", at(exception.name));
    documentation(2, exception.documentation);
  }

  void show(const Enum& enumeration) {
    line(1, "enum", at(enumeration.name));
    documentation(2, enumeration.documentation);
    for (const EnumValue& item : enumeration.values) {
      line(2, "value", at(item.name));
      documentation(3, item.documentation);
      if (item.value) number(3, *item.value);
    }
  }

  void show(const Record& record) {
    line(1, word(record_words, record.kind), at(record.name));
    documentation(2, record.documentation);
    options(2, record.options);
    for (const Constant& constant : record.constants) show(constant, 2);
    for (const Field& field : record.fields) {
      line(2, "field", at(field.name));
      documentation(3, field.documentation);
      line(3, type(field.type), "");
      modifiers(3, field.modifiers);
    }
  }

  void show(const Object& object) {
    line(1, "object", at(object.name));
    documentation(2, object.documentation);
    options(2, object.options);
    for (const Implements& written : object.implements) line(2, "implements", at(written.name));
    for (const Constant& constant : object.constants) show(constant, 2);
    for (const Member& member : object.members) show(member);
  }

  void show(const Member& member) {
    line(2, word(member_words, member.kind),
         fmt::format("{} of {}", at(member.name), place(member.span)));
    documentation(3, member.documentation);
    if (member.type) line(3, type(*member.type), "");
    for (const Parameter& parameter : member.parameters) {
      line(3, "parameter", at(parameter.name));
      line(4, type(parameter.type), "");
    }
    modifiers(3, member.modifiers);
  }

  const Source& source_;
  std::string text_;
};

}  // namespace

std::string dump(const File& file, const Source& source) { return Dump(source).run(file); }

}  // namespace robdef::ast
