// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstring>
#include <limits>

#include "rr/number.hpp"
#include "runtime/cpp/src/dynamic/testing/random_definition.hpp"
#include "runtime/cpp/src/dynamic/type_text.hpp"

namespace rr::dynamic::testing {
namespace {

constexpr int deepest = 3;

template <class T>
T random_number(Chance& chance) {
  if constexpr (std::is_same_v<T, bool>) {
    return chance.one_in(2);
  } else if constexpr (std::is_integral_v<T>) {
    const std::array values = {
        std::numeric_limits<T>::min(), std::numeric_limits<T>::max(), T{0}, T{1},
        static_cast<T>(chance.bits()), static_cast<T>(chance.bits())};
    return chance.pick(values);
  } else if constexpr (std::is_floating_point_v<T>) {
    using Limits = std::numeric_limits<T>;
    const T some = static_cast<T>(static_cast<std::int32_t>(chance.bits())) / T{1024};
    const std::array values = {T{0},
                               -T{0},
                               T{1},
                               some,
                               some,
                               some,
                               Limits::max(),
                               Limits::min(),
                               Limits::denorm_min(),
                               Limits::infinity(),
                               -Limits::infinity(),
                               Limits::quiet_NaN()};
    return chance.pick(values);
  } else {
    using Part = typename T::value_type;
    const Part real = random_number<Part>(chance);
    return {real, random_number<Part>(chance)};
  }
}

}  // namespace

Value RandomValues::number(ElementType type) {
  return with_number(type, [&](auto tag) -> Value {
    using T = typename decltype(tag)::type;
    return random_number<T>(chance_);
  });
}

std::string RandomValues::text() {
  constexpr std::array texts = {"",
                                "a",
                                "some text",
                                "line\nand tab\t",
                                "\"quoted\" \\",
                                "\xC3\xA9t\xC3\xA9",
                                "\xE4\xB8\xAD\xE6\x96\x87",
                                "1e5",
                                "null"};
  return chance_.pick(texts);
}

std::vector<std::uint32_t> RandomValues::dims() {
  std::vector<std::uint32_t> dims(chance_.below(3) + 1);
  for (std::uint32_t& one : dims) one = static_cast<std::uint32_t>(chance_.below(4));
  return dims;
}

List RandomValues::list(const ValueType& item, std::size_t count, int depth) {
  List items;
  for (std::size_t i = 0; i < count; ++i) items.push_back(value(item, depth + 1));
  return items;
}

Value RandomValues::array(const ValueType& type) {
  const ArrayBounds bounds = parse_type_text(type.text())->bounds;
  if (bounds.has_dims) {
    const std::vector<std::uint32_t> shape = bounds.shape.empty() ? dims() : bounds.shape;
    std::size_t count = 1;
    for (const std::uint32_t one : shape) count *= one;
    return type.convert(
        StringMap{{"dims", Value(shape)}, {"array", list(type.item(), count, deepest)}});
  }
  std::size_t count = chance_.below(5);
  if (bounds.maximum != any_length) {
    count = bounds.minimum + chance_.below(bounds.maximum - bounds.minimum + 1);
  }
  return type.convert(list(type.item(), count, deepest));
}

// What a varvalue holds comes back as it is: numbers are arrays, and so are pods and namedarrays.
Value RandomValues::any(int depth) {
  if (depth > deepest || chance_.one_in(8)) return {};
  constexpr std::array types = {"double[]",         "uint8[]",        "int64[]", "bool[]",
                                "csingle[]",        "single[*]",      "string",  "varvalue{list}",
                                "varvalue{string}", "varvalue{int32}"};
  constexpr std::array named = {"Note", "Report", "Sample[]", "Burst[*]", "Inner[]", "Outer[*]"};
  const std::string service = definitions_.services().at(0);
  const std::string type =
      chance_.one_in(2) ? std::string(chance_.pick(types)) : service + "." + chance_.pick(named);
  return value(definitions_.type(type), depth + 1);
}

Value RandomValues::value(const ValueType& type, int depth) {
  switch (type.kind()) {
    case Kind::number:
      return number(type.number());
    case Kind::text:
      return text();
    case Kind::enumeration: {
      const auto names = type.enum_values();
      return type.convert(chance_.pick(names).second);
    }
    case Kind::array:
      return array(type);
    case Kind::any:
      return any(depth);
    default:
      break;
  }
  const bool may_be_null = type.kind() != Kind::record || type.record_kind() == RecordKind::struct_;
  if (may_be_null && (depth > deepest || chance_.one_in(8))) return {};
  if (type.kind() == Kind::record) {
    Fields fields;
    for (const Field& field : type.fields()) {
      fields.emplace_back(field.name, value(field.type, depth + 1));
    }
    return type.convert(Value::record(std::move(fields)));
  }
  const List items = list(type.item(), chance_.below(4), depth);
  if (type.kind() == Kind::list) return type.convert(items);
  if (type.kind() == Kind::int_map) {
    IntMap map;
    for (const Value& item : items) map.emplace(random_number<std::int32_t>(chance_), item);
    return type.convert(map);
  }
  StringMap map;
  for (const Value& item : items) map.emplace(text(), item);
  return type.convert(map);
}

}  // namespace rr::dynamic::testing
