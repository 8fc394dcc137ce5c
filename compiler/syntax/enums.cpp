// SPDX-License-Identifier: Apache-2.0
// Checks the names and numbers of an enum. Reports R0133 (first value), R0303 (range), R0304
// (twice), R0326 (wraps).
#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <unordered_map>

#include "compiler/syntax/constants.hpp"
#include "compiler/syntax/literals.hpp"

namespace robdef::syntax {
namespace {

constexpr std::int32_t largest = std::numeric_limits<std::int32_t>::max();

class EnumCheck {
 public:
  EnumCheck(bool is_whole, Report& report) : is_whole_(is_whole), report_(report) {}

  void run(const ast::Enum& enumeration) {
    for (const ast::EnumValue& value : enumeration.values) {
      const bool is_first = &value == &enumeration.values.front();
      if (is_first && !value.value && is_whole_) {
        report_.add(Code::R0133, value.name.span, "the first value of an enum has no number")
            .label("a number is wanted here")
            .help(fmt::format("write for instance `{} = 0`", value.name.text));
      }
      number_ = value.value ? explicit_number(*value.value) : next_number(value);
      check_name(value);
      check_number(value);
    }
  }

 private:
  std::optional<std::int32_t> explicit_number(const ast::NumberLiteral& literal) {
    const Integer integer = read_integer(literal.text);
    if (!fits(integer, true, 32)) {
      Diagnostic& diagnostic =
          report_.add(Code::R0303, literal.span, "an enum value beyond 32 bits")
              .label("the range is -2147483648 to 2147483647");
      if (integer.is_hexadecimal && !integer.is_negative && fits(integer, false, 32)) {
        diagnostic.note("hexadecimal numbers have no sign bit: write a minus sign");
      }
      return std::nullopt;
    }
    const auto magnitude = static_cast<std::int64_t>(integer.magnitude);
    return static_cast<std::int32_t>(integer.is_negative ? -magnitude : magnitude);
  }

  std::optional<std::int32_t> next_number(const ast::EnumValue& value) {
    if (!number_ || !is_whole_) return std::nullopt;
    if (*number_ < largest) return *number_ + 1;
    report_.add(Code::R0326, value.name.span, "an enum value that wraps around")
        .label("follows 2147483647 and becomes -2147483648")
        .help("give the number");
    return std::numeric_limits<std::int32_t>::min();
  }

  void check_name(const ast::EnumValue& value) {
    const auto [first, is_new] = names_.try_emplace(value.name.text, value.name.span);
    if (is_new) return;
    report_
        .add(Code::R0304, value.name.span,
             fmt::format("the enum value `{}` occurs twice", value.name.text))
        .also(first->second, "first here");
  }

  void check_number(const ast::EnumValue& value) {
    if (!number_) return;
    const auto [first, is_new] = numbers_.try_emplace(*number_, &value.name);
    if (is_new || first->second->text == value.name.text) return;
    report_
        .add(Code::R0304, value.name.span,
             fmt::format("two enum values have the number {}", *number_))
        .label(fmt::format("`{}` is {} too", value.name.text, *number_))
        .also(first->second->span, fmt::format("`{}` is {}", first->second->text, *number_));
  }

  bool is_whole_;
  Report& report_;
  std::optional<std::int32_t> number_;  ///< of the value before; none where it is not known
  std::unordered_map<std::string_view, Span> names_;
  std::unordered_map<std::int32_t, const ast::Name*> numbers_;
};

}  // namespace

void check_enum(const ast::Enum& enumeration, bool is_whole, Report& report) {
  EnumCheck(is_whole, report).run(enumeration);
}

}  // namespace robdef::syntax
