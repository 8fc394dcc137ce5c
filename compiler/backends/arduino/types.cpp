// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/arduino/types.hpp"

#include <algorithm>
#include <variant>

#include "compiler/backends/arduino/names.hpp"

namespace robdef::arduino {
namespace {

using model::ArrayForm;
using model::Primitive;

/// Arrays and strings have their length in one byte.
constexpr std::uint64_t count_limit = 245;

std::string number_text(Primitive primitive) {
  switch (primitive) {
    case Primitive::double_:
      return "double";
    case Primitive::single:
      return "float";
    case Primitive::bool_:
      return "bool";
    case Primitive::cdouble:
      return "rr::Complex<double>";
    case Primitive::csingle:
      return "rr::Complex<float>";
    case Primitive::void_:
    case Primitive::string:
      return "";
    default:
      return std::string(model::name_of(primitive)) + "_t";
  }
}

}  // namespace

void BoardTypes::refuse(Span span, const std::string& what, const std::string& hint) {
  report_.add(Code::R0920, span, what + " cannot be served by a board").help(hint);
}

void BoardTypes::need_limit(const model::Type& type, const std::string& what,
                            const TypePlace& place) {
  const std::string name = place.limit_name.empty() ? "" : place.limit_name + " ";
  report_.add(Code::R0921, type.span, what + " needs a limit on a board")
      .help("write `## @limit " + name + "16` in the documentation above, with a number that fits");
}

void BoardTypes::check_size(std::uint64_t size, Span span, std::string_view what) {
  if (size <= message_limit) return;
  report_
      .add(Code::R0922, span,
           std::string(what) + " of up to " + std::to_string(size) +
               " bytes do not fit into a message of a board")
      .help("a message holds " + std::to_string(message_limit) +
            " bytes: give smaller limits, or send the parts one after the other");
}

BoardType BoardTypes::record(const model::Record& record, Span span) {
  const auto known = std::ranges::find(known_, &record, &decltype(known_)::value_type::first);
  if (known != known_.end()) return known->second;
  BoardType result{qualified(*record.definition, identifier(code_name(record)))};
  if (record.is_recursive) {
    refuse(span, "`" + record.name + "`, which may contain itself,",
           "refer to the other one by a number instead");
    return result;
  }
  for (const model::Field& field : record.fields) {
    const Limits limits(field.documentation, field.span, report_);
    const BoardType type = spell(field.type, {limits, ""});
    limits.report_unused(report_);
    result.size += type.size;
    result.has_double = result.has_double || type.has_double;
  }
  known_.emplace_back(&record, result);
  records_.push_back(&record);
  return result;
}

BoardType BoardTypes::base(const model::Type& type, const TypePlace& place) {
  if (const auto* primitive = std::get_if<Primitive>(&type.base)) {
    if (*primitive == Primitive::string) {
      const auto limit = place.limits.of(place.limit_name);
      if (!limit) {
        need_limit(type, "a string", place);
        return {};
      }
      const std::uint64_t size = std::uint64_t{*limit} + 1;
      return {"rr::Text<" + std::to_string(std::min<std::uint64_t>(*limit, count_limit)) + ">",
              size};
    }
    const bool is_complex = *primitive == Primitive::cdouble || *primitive == Primitive::csingle;
    return {number_text(*primitive), model::size_of(*primitive), !is_complex,
            *primitive == Primitive::double_ || *primitive == Primitive::cdouble};
  }
  if (const auto* enumeration = std::get_if<const model::Enum*>(&type.base)) {
    return {qualified(*(*enumeration)->definition, identifier(code_name(**enumeration))), 4, true};
  }
  if (const auto* found = std::get_if<const model::Record*>(&type.base)) {
    return record(**found, type.span);
  }
  if (std::holds_alternative<model::VarValue>(type.base)) {
    refuse(type.span, "a varvalue", "declare the type that is meant, or one member for each");
  } else if (!std::holds_alternative<model::Unknown>(type.base)) {
    refuse(type.span, "an object as a value", "use an objref");
  }
  return {};
}

BoardType BoardTypes::spell(const model::Type& type, const TypePlace& place) {
  if (type.is_void()) return {};
  if (type.container != model::ContainerForm::none) {
    refuse(type.span, "a list or map", "use an array with a maximum length, as `double[8-]`");
    return {};
  }
  if (type.array == ArrayForm::any_shape) {
    refuse(type.span, "an array of any shape", "give the shape, as `double[3,3]`");
    return {};
  }
  if (type.array == ArrayForm::fixed_shape &&
      std::holds_alternative<const model::Record*>(type.base)) {
    refuse(type.span, "an array of records with a shape", "give its length, as `Point[6]`");
    return {};
  }
  BoardType item = base(type, place);
  if (item.text.empty() || type.array == ArrayForm::none) return item;
  std::uint64_t count = type.element_count();
  if (type.array == ArrayForm::any_length) {
    const auto limit = place.limits.of(place.limit_name);
    if (!limit) {
      need_limit(type, "an array without a length", place);
      return {};
    }
    count = *limit;
  }
  const bool is_fixed =
      type.array == ArrayForm::fixed_length || type.array == ArrayForm::fixed_shape;
  const std::uint64_t size =
      std::min<std::uint64_t>(count, 0xFFFFFF) * item.size + (is_fixed ? 0 : 1);
  return {(is_fixed ? "rr::Fixed<" : "rr::Bounded<") + item.text + ", " +
              std::to_string(std::min(count, count_limit)) + ">",
          size, false, item.has_double};
}

}  // namespace robdef::arduino
