// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/serial/packing.hpp"

#include <bit>
#include <cstring>
#include <string>
#include <utility>

#include "rr/error.hpp"
#include "rr/number.hpp"
#include "runtime/cpp/src/dynamic/tables.hpp"

namespace rr::serial {
namespace {

using dynamic::TypeNode;
using dynamic::Value;

static_assert(std::endian::native == std::endian::little, "numbers are copied as they are");

constexpr std::size_t longest = 246;

[[noreturn]] void refuse(ErrorCode code, const TypeNode& type, const char* what) {
  throw Error(code, type.text() + ": " + what);
}

void put_count(const TypeNode& type, std::size_t count, std::vector<std::uint8_t>& bytes) {
  if (count > longest)
    refuse(ErrorCode::buffer_limit_violation, type, "longer than a message to a board");
  bytes.push_back(static_cast<std::uint8_t>(count));
}

std::span<const std::uint8_t> take(const TypeNode& type, std::size_t count,
                                   std::span<const std::uint8_t>& bytes) {
  if (count > bytes.size()) {
    refuse(ErrorCode::data_serialization_error, type, "the board has sent too little");
  }
  const auto taken = bytes.first(count);
  bytes = bytes.subspan(count);
  return taken;
}

template <class T>
void put_number(T number, std::vector<std::uint8_t>& bytes) {
  std::uint8_t raw[sizeof number];
  std::memcpy(raw, &number, sizeof number);
  bytes.insert(bytes.end(), raw, raw + sizeof number);
}

void pack_number(ElementType number, const Value& value, std::vector<std::uint8_t>& bytes) {
  with_number(number,
              [&](auto type) { put_number(value.as<typename decltype(type)::type>(), bytes); });
}

Value unpack_number(const TypeNode& type, ElementType number,
                    std::span<const std::uint8_t>& bytes) {
  return with_number(number, [&](auto tag) -> Value {
    using Number = typename decltype(tag)::type;
    const auto raw = take(type, sizeof(Number), bytes);
    if constexpr (std::is_same_v<Number, bool>) {
      if (raw[0] > 1) refuse(ErrorCode::data_serialization_error, type, "no truth");
      return raw[0] != 0;
    } else {
      Number value{};
      std::memcpy(&value, raw.data(), sizeof value);
      return value;
    }
  });
}

void pack_text(const TypeNode& type, const Value& value, std::vector<std::uint8_t>& bytes) {
  const std::string text = value.text();
  if (text.find('\0') != std::string::npos) {
    refuse(ErrorCode::data_type_error, type, "a string for a board cannot have a zero in it");
  }
  put_count(type, text.size(), bytes);
  bytes.insert(bytes.end(), text.begin(), text.end());
}

/// Items of arrays are laid out by the number of the type itself.
const TypeNode& item_of(const TypeNode& type) { return *type.item(); }

void pack_array(const TypeNode& type, const Value& value, std::vector<std::uint8_t>& bytes) {
  const dynamic::ArrayBounds& bounds = static_cast<const dynamic::ArrayNode&>(type).bounds();
  const bool is_fixed = !bounds.shape.empty() || bounds.minimum == bounds.maximum;
  if (!is_fixed) put_count(type, value.size(), bytes);
  if (value.size() > longest)
    refuse(ErrorCode::buffer_limit_violation, type, "longer than a message to a board");
  for (const Value& item : value.items()) pack(item_of(type), item, bytes);
}

Value unpack_array(const TypeNode& type, std::span<const std::uint8_t>& bytes) {
  const dynamic::ArrayBounds& bounds = static_cast<const dynamic::ArrayNode&>(type).bounds();
  std::size_t count = bounds.minimum;
  if (!bounds.shape.empty()) {
    count = 1;
    for (const std::uint32_t dimension : bounds.shape) count *= dimension;
  } else if (bounds.minimum != bounds.maximum) {
    count = take(type, 1, bytes)[0];
  }
  if (count > longest) refuse(ErrorCode::data_serialization_error, type, "longer than a frame");
  dynamic::List items;
  for (std::size_t at = 0; at < count; ++at) items.push_back(unpack(item_of(type), bytes));
  if (!bounds.has_dims) return Value(std::move(items));
  return with_number(type.number(), [&](auto tag) -> Value {
    using Number = typename decltype(tag)::type;
    MultiArray<Number> array;
    array.dims = bounds.shape;
    std::vector<Number> numbers;
    for (const Value& item : items) numbers.push_back(item.as<Number>());
    array.items = Array<Number>(numbers);
    return Value(std::move(array));
  });
}

}  // namespace

void pack(const TypeNode& type, const Value& value, std::vector<std::uint8_t>& bytes) {
  switch (type.kind()) {
    case dynamic::Kind::number:
    case dynamic::Kind::enumeration:
      pack_number(type.number(), value, bytes);
      return;
    case dynamic::Kind::text:
      pack_text(type, value, bytes);
      return;
    case dynamic::Kind::array:
      pack_array(type, value, bytes);
      return;
    case dynamic::Kind::record:
      if (value.is_null()) refuse(ErrorCode::null_value, type, "a board has no null");
      for (const dynamic::FieldTable& field : type.record()->fields) {
        pack(*field.type, value.at(field.name), bytes);
      }
      return;
    default:
      refuse(ErrorCode::data_type_error, type, "boards do not have this type");
  }
}

Value unpack(const TypeNode& type, std::span<const std::uint8_t>& bytes) {
  const auto as_type = [&](const Value& value) { return type.convert(value, dynamic::Place({})); };
  switch (type.kind()) {
    case dynamic::Kind::number:
    case dynamic::Kind::enumeration:
      return as_type(unpack_number(type, type.number(), bytes));
    case dynamic::Kind::text: {
      const std::size_t count = take(type, 1, bytes)[0];
      const auto text = take(type, count, bytes);
      return Value(std::string(text.begin(), text.end()));
    }
    case dynamic::Kind::array:
      return as_type(unpack_array(type, bytes));
    case dynamic::Kind::record: {
      dynamic::Fields fields;
      for (const dynamic::FieldTable& field : type.record()->fields) {
        fields.emplace_back(field.name, unpack(*field.type, bytes));
      }
      return as_type(Value::record(std::move(fields)));
    }
    default:
      refuse(ErrorCode::data_type_error, type, "boards do not have this type");
  }
}

}  // namespace rr::serial
