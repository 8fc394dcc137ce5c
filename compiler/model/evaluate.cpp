// SPDX-License-Identifier: Apache-2.0
// Gives constants and enum values their values. Reads the literals that resolve kept; fills
// Constant::value and EnumValue. Reports R0305 (struct constants).
#include "compiler/model/evaluate.hpp"

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

#include "compiler/diagnostics/spelling.hpp"
#include "compiler/model/graph.hpp"
#include "compiler/model/phrases.hpp"
#include "compiler/model/syntax_errors.hpp"
#include "compiler/syntax/literals.hpp"

namespace robdef::model {
namespace {

std::optional<Number> signed_number(const syntax::Integer& literal, int bits) {
  if (!syntax::fits(literal, true, bits)) return std::nullopt;
  // Negated as unsigned, since the smallest number has no positive counterpart.
  return static_cast<std::int64_t>(literal.is_negative ? 0 - literal.magnitude : literal.magnitude);
}

std::optional<Number> unsigned_number(const syntax::Integer& literal, int bits) {
  if (!syntax::fits(literal, false, bits)) return std::nullopt;
  const std::uint64_t mask = std::numeric_limits<std::uint64_t>::max() >> (64 - bits);
  return literal.is_negative ? (0 - literal.magnitude) & mask : literal.magnitude;
}

template <class Float>
std::optional<Number> float_number(std::string_view literal) {
  constexpr bool is_single = sizeof(Float) == sizeof(float);
  const syntax::FloatFit fit = syntax::fit_float(literal, is_single);
  if (fit == syntax::FloatFit::overflows) return std::nullopt;
  const bool is_negative = literal.starts_with('-');
  if (is_negative || literal.starts_with('+')) literal.remove_prefix(1);
  Float magnitude = 0;
  if (fit == syntax::FloatFit::fits) {
    std::from_chars(literal.data(), literal.data() + literal.size(), magnitude);
  }
  const double value = magnitude;
  return is_negative ? -value : value;
}

// One scope: the constants of a file or of a block.
class Constants {
 public:
  Constants(std::vector<Constant>& constants, const Definition& definition, bool is_block,
            const SyntaxErrors& syntax_errors, Report& report)
      : constants_(constants),
        definition_(definition),
        is_block_(is_block),
        syntax_errors_(syntax_errors),
        report_(report),
        references_(constants.size()) {}

  void evaluate() {
    for (std::size_t i = 0; i < constants_.size(); ++i) by_name_.try_emplace(constants_[i].name, i);
    for (std::size_t i = 0; i < constants_.size(); ++i) {
      Constant& constant = constants_[i];
      if (const auto* literal = std::get_if<ast::StructLiteral>(&constant.written)) {
        constant.value = fields(*literal, i);
      } else if (const auto* text = std::get_if<ast::StringLiteral>(&constant.written)) {
        constant.value = text->value;
      } else if (const auto* array = std::get_if<ast::ArrayLiteral>(&constant.written)) {
        constant.value = numbers(*array, constant);
      } else {
        constant.value = number(std::get<ast::NumberLiteral>(constant.written), constant);
      }
    }
    report_cycles();
  }

 private:
  static Number number(const ast::NumberLiteral& literal, const Constant& constant) {
    const auto* type = std::get_if<Primitive>(&constant.type.base);
    if (type == nullptr) return Number{};
    return number_of(*type, literal.text).value_or(Number{});
  }

  static std::vector<Number> numbers(const ast::ArrayLiteral& array, const Constant& constant) {
    std::vector<Number> values;
    values.reserve(array.items.size());
    for (const ast::NumberLiteral& item : array.items) values.push_back(number(item, constant));
    return values;
  }

  std::vector<StructValueField> fields(const ast::StructLiteral& literal, std::size_t owner) {
    std::vector<StructValueField> values;
    for (std::size_t i = 0; i < literal.fields.size(); ++i) {
      const ast::StructLiteralField& written = literal.fields[i];
      const auto found = by_name_.find(written.constant.text);
      if (found == by_name_.end()) {
        report_unknown(written.constant);
        continue;
      }
      references_.add_edge(owner, found->second, i);
      values.push_back({written.field.text, &constants_[found->second], written.field.span});
    }
    return values;
  }

  void report_unknown(const ast::Name& name) {
    if (syntax_errors_.mention(definition_, name.text)) return;
    Diagnostic& diagnostic =
        report_.add(Code::R0305, name.span, "unknown constant " + in_ticks(name.text));
    const std::string_view scope = is_block_ ? "block" : "file";
    diagnostic.label("no constant of this " + std::string(scope) + " has this name");
    const std::size_t count = constants_.size() + definition_.constants.size();
    if (!report_.may_suggest(count, comparisons(name.text))) return;
    if (is_block_ && suggest_file_constant(diagnostic, name.text)) return;
    std::vector<std::string_view> candidates;
    for (const Constant& constant : constants_) candidates.push_back(constant.name);
    const std::string_view near = nearest(name.text, candidates);
    if (!near.empty()) diagnostic.help(in_ticks(near) + " is close");
  }

  bool suggest_file_constant(Diagnostic& diagnostic, std::string_view name) const {
    for (const Constant& constant : definition_.constants) {
      if (constant.name != name) continue;
      diagnostic.also(constant.span, "this one belongs to the file");
      diagnostic.help("declare it in the block");
      diagnostic.note("constants of a block cannot refer to those of the file");
      return true;
    }
    return false;
  }

  [[nodiscard]] const ast::Name& reference(const Graph::Edge& edge) const {
    const auto& literal = std::get<ast::StructLiteral>(constants_[edge.from].written);
    return literal.fields[edge.label].constant;
  }

  void report_cycles() {
    for (const std::vector<Graph::Edge>& cycle : references_.cycles()) {
      const ast::Name& first = reference(cycle.front());
      const std::string& name = constants_[cycle.front().from].name;
      Diagnostic& diagnostic =
          report_.add(Code::R0305, first.span, "constant " + in_ticks(name) + " contains itself");
      diagnostic.label(cycle.size() == 1 ? "the constant itself" : "through this one");
      for (std::size_t i = 1; i < cycle.size(); ++i) {
        diagnostic.also(reference(cycle[i]).span,
                        "which contains " + in_ticks(reference(cycle[i]).text));
      }
    }
  }

  std::vector<Constant>& constants_;
  const Definition& definition_;
  bool is_block_;
  const SyntaxErrors& syntax_errors_;
  Report& report_;
  std::unordered_map<std::string_view, std::size_t> by_name_;
  Graph references_;
};

// Values without a number follow the one before, in its spelling; after the largest comes the
// smallest (Q18).
void evaluate_enum(Enum& enumeration) {
  std::uint32_t next = 0;
  bool is_hexadecimal = false;
  for (EnumValue& value : enumeration.values) {
    if (value.written) {
      const auto number = number_of(Primitive::int32, value.written->text);
      next = static_cast<std::uint32_t>(number ? std::get<std::int64_t>(*number) : 0);
      is_hexadecimal = value.written->text.find('x') != std::string::npos;
    }
    value.value = static_cast<std::int32_t>(next++);
    value.is_hexadecimal = is_hexadecimal;
  }
}

}  // namespace

std::optional<Number> number_of(Primitive type, std::string_view literal) {
  const auto bits = static_cast<int>(8 * size_of(type));
  switch (type) {
    case Primitive::int8:
    case Primitive::int16:
    case Primitive::int32:
    case Primitive::int64:
      return signed_number(syntax::read_integer(literal), bits);
    case Primitive::uint8:
    case Primitive::uint16:
    case Primitive::uint32:
    case Primitive::uint64:
      return unsigned_number(syntax::read_integer(literal), bits);
    case Primitive::double_:
      return float_number<double>(literal);
    case Primitive::single:
      return float_number<float>(literal);
    case Primitive::void_:
    case Primitive::string:
    case Primitive::cdouble:
    case Primitive::csingle:
    case Primitive::bool_:
      break;
  }
  return std::nullopt;
}

void evaluate(Model& model, Report& report) {
  const SyntaxErrors syntax_errors(report);
  for (const auto& definition : model.definitions()) {
    const auto scope = [&](std::vector<Constant>& constants, bool is_block) {
      if (constants.empty()) return;
      Constants(constants, *definition, is_block, syntax_errors, report).evaluate();
    };
    scope(definition->constants, false);
    for (Record& record : definition->records) scope(record.constants, true);
    for (Object& object : definition->objects) scope(object.constants, true);
    for (Enum& enumeration : definition->enums) evaluate_enum(enumeration);
  }
}

}  // namespace robdef::model
