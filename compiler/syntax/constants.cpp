// SPDX-License-Identifier: Apache-2.0
// Checks constants. Reports R0301 (type), R0302 (value) and the warnings R0321 to R0325, R0327,
// R0328.
#include "compiler/syntax/constants.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>
#include <unordered_set>

#include "compiler/diagnostics/spelling.hpp"
#include "compiler/syntax/literals.hpp"
#include "compiler/syntax/words.hpp"

namespace robdef::syntax {
namespace {

struct IntegerType {
  std::string_view name;
  bool is_signed;
  int bits;
};

constexpr std::array<IntegerType, 8> integer_types = {{{"int8", true, 8},
                                                       {"uint8", false, 8},
                                                       {"int16", true, 16},
                                                       {"uint16", false, 16},
                                                       {"int32", true, 32},
                                                       {"uint32", false, 32},
                                                       {"int64", true, 64},
                                                       {"uint64", false, 64}}};

const IntegerType* integer_type(std::string_view name) {
  for (const IntegerType& type : integer_types) {
    if (type.name == name) return &type;
  }
  return nullptr;
}

std::string range_of(const IntegerType& type) {
  const std::uint64_t largest = ~std::uint64_t{0} >> (64 - type.bits);
  if (!type.is_signed) return fmt::format("0 to {}", largest);
  return fmt::format("-{} to {}", (largest >> 1) + 1, largest >> 1);
}

std::string_view value_words(const ast::ConstantValue& value) {
  constexpr std::array<std::string_view, 4> words = {"a number", "a string", "an array",
                                                     "a struct constant"};
  return words[value.index()];
}

Span span_of(const ast::ConstantValue& value) {
  return std::visit([](const auto& literal) { return literal.span; }, value);
}

class ConstantCheck {
 public:
  ConstantCheck(const ast::Constant& constant, Report& report)
      : constant_(constant), report_(report) {}

  bool run() {
    const std::string_view base = constant_.type.base.text;
    if (base == "single" || base == "double" || integer_type(base) != nullptr) return number();
    if (base == "string") return text();
    if (is_built_in_type(base)) return refuse_type(constant_.type.base.span);
    return fields();
  }

 private:
  bool number() {
    const ast::TypeRef& type = constant_.type;
    if (type.container != ast::ContainerForm::none) return refuse_type(type.container_span);
    switch (type.array) {
      case ast::ArrayForm::none: {
        const auto* const literal = std::get_if<ast::NumberLiteral>(&constant_.value);
        return literal == nullptr ? refuse_value("a number") : element(*literal);
      }
      case ast::ArrayForm::any_length:
      case ast::ArrayForm::fixed_length:
      case ast::ArrayForm::maximum_length:
        return array();
      case ast::ArrayForm::any_shape:
      case ast::ArrayForm::fixed_shape:
        break;
    }
    return refuse_type(type.array_span);
  }

  bool array() {
    const auto* const literal = std::get_if<ast::ArrayLiteral>(&constant_.value);
    if (literal == nullptr) return refuse_value("an array of numbers, `{...}`");
    bool is_fine = true;
    for (const ast::NumberLiteral& item : literal->items) is_fine = element(item) && is_fine;
    if (is_fine) doubt_length(*literal);
    return is_fine;
  }

  bool element(const ast::NumberLiteral& literal) {
    const IntegerType* const type = integer_type(constant_.type.base.text);
    return type == nullptr ? floating(literal) : integer(literal, *type);
  }

  bool integer(const ast::NumberLiteral& literal, const IntegerType& type) {
    const std::string_view text = literal.text;
    const bool is_hexadecimal = text.find("0x") != text.npos;
    if (!is_hexadecimal && text.find_first_of(".eE") != text.npos) {
      report_.add(Code::R0302, literal.span, fmt::format("a whole number is wanted"))
          .label(fmt::format("an {} has no fraction and no exponent", type.name));
      return false;
    }
    const Integer value = read_integer(text);
    if (!fits(value, type.is_signed, type.bits)) {
      Diagnostic& diagnostic =
          report_
              .add(Code::R0302, literal.span, fmt::format("a value that {} cannot hold", type.name))
              .label(fmt::format("the range is {}", range_of(type)));
      if (is_hexadecimal && fits(value, false, type.bits) && !value.is_negative) {
        diagnostic.note("hexadecimal numbers have no sign bit: write a minus sign");
      }
      return false;
    }
    doubt_integer(literal, value, type);
    return true;
  }

  bool floating(const ast::NumberLiteral& literal) {
    const std::string_view type = constant_.type.base.text;
    if (literal.text.find("0x") != std::string::npos) {
      report_.add(Code::R0302, literal.span, fmt::format("a hexadecimal number for a {}", type))
          .label("a decimal number is wanted");
      return false;
    }
    switch (fit_float(literal.text, type == "single")) {
      case FloatFit::fits:
        return true;
      case FloatFit::underflows:
        report_.add(Code::R0328, literal.span, fmt::format("too small for a {}", type))
            .label("becomes zero or loses digits");
        return true;
      case FloatFit::overflows:
        break;
    }
    report_.add(Code::R0302, literal.span, fmt::format("a value that a {} cannot hold", type))
        .label("too large");
    return false;
  }

  bool text() {
    const ast::TypeRef& type = constant_.type;
    if (type.array != ast::ArrayForm::none) return refuse_type(type.array_span);
    if (!std::holds_alternative<ast::StringLiteral>(constant_.value)) {
      return refuse_value("a string in quotes");
    }
    if (type.container != ast::ContainerForm::none) {
      report_.add(Code::R0321, type.container_span, "a string constant with a container")
          .label("has no effect")
          .help("write `string`")
          .edit(type.container_span, "");
    }
    return true;
  }

  // `struct`, or any other word (Q14).
  bool fields() {
    const ast::TypeRef& type = constant_.type;
    if (type.array != ast::ArrayForm::none) return refuse_type(type.array_span);
    if (type.container != ast::ContainerForm::none) return refuse_type(type.container_span);
    const auto* const literal = std::get_if<ast::StructLiteral>(&constant_.value);
    if (literal == nullptr) {
      return type.base.text == "struct" ? refuse_value("`{field: CONSTANT, ...}`")
                                        : refuse_type(type.base.span);
    }
    if (type.base.text != "struct") {
      report_
          .add(Code::R0324, type.base.span,
               fmt::format("`{}` as the type of a struct constant", type.base.text))
          .help("write `struct`")
          .edit(type.base.span, "struct");
    }
    doubt_fields(*literal);
    return true;
  }

  bool refuse_type(Span place) {
    const ast::Name& base = constant_.type.base;
    Diagnostic& diagnostic = report_.add(Code::R0301, place, "a constant cannot have this type");
    diagnostic.label("numbers, arrays of numbers of one dimension, strings and structs only");
    if (!is_built_in_type(base.text) && base.span == place && report_.may_suggest(1)) {
      static const std::vector<std::string_view> types = {"double", "single", "int8",   "uint8",
                                                          "int16",  "uint16", "int32",  "uint32",
                                                          "int64",  "uint64", "string", "struct"};
      const std::string_view near = nearest(base.text, types);
      if (!near.empty()) {
        diagnostic.help(fmt::format("`{}` is close", near)).edit(base.span, std::string(near));
      }
    }
    return false;
  }

  bool refuse_value(std::string_view wanted) {
    report_
        .add(Code::R0302, span_of(constant_.value),
             fmt::format("{} does not fit the type `{}`", value_words(constant_.value),
                         constant_.type.base.text))
        .label(fmt::format("{} belongs here", wanted));
    return false;
  }

  void doubt_integer(const ast::NumberLiteral& literal, const Integer& value,
                     const IntegerType& type) {
    if (!type.is_signed && value.is_negative) {
      report_.add(Code::R0323, literal.span, fmt::format("a negative value for {}", type.name))
          .label("wraps around");
    }
    if (type.bits == 8 && literal.text.size() > 1 && !doubted_digits_) {
      doubted_digits_ = true;
      report_
          .add(Code::R0327, literal.span,
               fmt::format("an {} constant of more than one digit", type.name))
          .label("other tools cannot read it");
    }
  }

  void doubt_length(const ast::ArrayLiteral& literal) {
    const ast::TypeRef& type = constant_.type;
    if (type.dimensions.empty() || type.dimensions.front() == 0) return;
    const std::size_t length = type.dimensions.front();
    const std::size_t written = literal.items.size();
    const bool is_maximum = type.array == ast::ArrayForm::maximum_length;
    if (written == length || (is_maximum && written < length)) return;
    report_
        .add(Code::R0322, literal.span,
             fmt::format("{} elements in a constant of type `{}[{}{}]`", written, type.base.text,
                         length, is_maximum ? "-" : ""))
        .also(type.array_span, "the length");
  }

  void doubt_fields(const ast::StructLiteral& literal) {
    std::unordered_set<std::string_view> seen;
    for (const ast::StructLiteralField& field : literal.fields) {
      if (seen.insert(field.field.text).second) continue;
      report_.add(Code::R0325, field.field.span,
                  fmt::format("the field `{}` occurs twice", field.field.text));
    }
  }

  const ast::Constant& constant_;
  Report& report_;
  bool doubted_digits_ = false;
};

}  // namespace

bool check_constant(const ast::Constant& constant, Report& report) {
  return ConstantCheck(constant, report).run();
}

}  // namespace robdef::syntax
