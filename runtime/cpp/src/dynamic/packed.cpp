// SPDX-License-Identifier: Apache-2.0
// Pods and namedarrays in memory.
#include <algorithm>
#include <cstring>
#include <limits>

#include "rr/error.hpp"
#include "runtime/cpp/src/dynamic/numbers.hpp"
#include "runtime/cpp/src/dynamic/tables.hpp"

namespace rr::dynamic {
namespace {

// Far more than fits a message: what a definition asks for is not to be believed without limit.
constexpr std::uint64_t largest_record = 64ULL * 1024 * 1024;

std::uint64_t round_up(std::uint64_t size, std::uint64_t alignment) {
  return (size + alignment - 1) / alignment * alignment;
}

// A field in memory.
struct Extent {
  std::uint64_t size = 0;
  std::uint64_t alignment = 1;
  std::uint64_t items_offset = 0;  // of an array with a count in front
};

bool is_bounded(const ArrayNode& array) {
  return !array.has_dims() && array.bounds().minimum != array.bounds().maximum;
}

// Items of an array that is in a pod or namedarray, at most.
std::uint64_t item_count(const ArrayNode& array) {
  const ArrayBounds& bounds = array.bounds();
  if (!bounds.has_dims) return bounds.maximum;
  std::uint64_t count = 1;
  for (const std::uint32_t dim : bounds.shape) {
    if (__builtin_mul_overflow(count, dim, &count)) return largest_record + 1;
  }
  return count;
}

Extent extent_of(const TypeNode& type) {
  const std::uint64_t alignment =
      type.record() != nullptr ? type.record()->alignment : alignment_of(type.number());
  if (type.kind() == Kind::record) return {type.record()->size, alignment};
  if (type.kind() != Kind::array) return {item_size(type.number()), alignment};
  const auto& array = static_cast<const ArrayNode&>(type);
  const std::uint64_t count = std::min(item_count(array), largest_record + 1);
  const std::uint64_t size =
      count * (array.record() != nullptr ? array.record()->size : item_size(array.number()));
  if (!is_bounded(array)) return {size, alignment};
  // As in rr::BoundedArray.
  const std::uint64_t around = std::max<std::uint64_t>(alignment, sizeof(std::uint32_t));
  return {round_up(around + size, around), around, around};
}

void check_size(const RecordTable& table, std::uint64_t size) {
  if (size <= largest_record) return;
  throw Error(ErrorCode::service_definition_error,
              "`" + table.name + "` is larger than any message");
}

void lay_out(RecordTable& table) {
  std::uint64_t size = 0;
  std::uint64_t alignment = 1;
  for (FieldTable& field : table.fields) {
    const Extent extent = extent_of(*field.type);
    size = round_up(size, extent.alignment);
    field.offset = static_cast<std::size_t>(size);
    size += extent.size;
    alignment = std::max(alignment, extent.alignment);
    check_size(table, size);
  }
  // As in C++, a pod without fields has a place of its own in an array.
  if (table.kind == RecordKind::pod) size = std::max<std::uint64_t>(size, 1);
  size = round_up(size, alignment);
  check_size(table, size);
  table.size = static_cast<std::size_t>(size);
  table.alignment = static_cast<std::size_t>(alignment);
}

rr::Field packed_field(RecordTable& table, const FieldTable& field) {
  rr::Field result{field.name, static_cast<std::uint32_t>(field.offset), Shortcut::none, nullptr,
                   ScalarPrefix()};
  const TypeNode& type = *field.type;
  if (type.kind() == Kind::record) {
    result.type = type.record()->wire_type.get();
    return result;
  }
  if (type.kind() != Kind::array) {
    result.type = &number_wire_type(type.number());
    return result;
  }
  const auto& array = static_cast<const ArrayNode&>(type);
  const auto count = static_cast<std::uint32_t>(item_count(array));
  PackedType& packed =
      array.has_dims() ? table.packed_types.emplace_back(
                             FixedMultiArrayType(array.wire_item(), array.bounds().shape, count))
      : is_bounded(array)
          ? table.packed_types.emplace_back(BoundedArrayType(
                array.wire_item(), count, static_cast<std::uint32_t>(extent_of(type).items_offset)))
          : table.packed_types.emplace_back(FixedArrayType(array.wire_item(), count));
  if (array.has_dims()) result.shortcut = Shortcut::fixed_multi_array;
  std::visit([&](const rr::Type& known) { result.type = &known; }, packed);
  return result;
}

Value unpack_array(const ArrayNode& array, const std::byte* memory) {
  auto content = std::make_shared<ArrayContent>();
  content->number = array.number();
  if (array.record() != nullptr) content->record = own(*array.record());
  content->has_dims = array.has_dims();
  std::size_t count = static_cast<std::size_t>(item_count(array));
  if (is_bounded(array)) {
    std::uint32_t current = 0;
    std::memcpy(&current, memory, sizeof current);
    count = current;
    memory += extent_of(array).items_offset;
  }
  if (array.has_dims()) content->data.dims = array.bounds().shape;
  const std::size_t size = array.wire_item().size;
  std::byte* const room = content->data.items.make_room(count, size);
  if (count != 0) std::memcpy(room, memory, count * size);
  return value_of(Kind::array, std::move(content));
}

void pack_array(const Value& value, const ArrayNode& array, std::byte* memory) {
  const ArrayStorage& items = content_of<ArrayContent>(value).data.items;
  if (is_bounded(array)) {
    const auto current = static_cast<std::uint32_t>(items.count());
    std::memcpy(memory, &current, sizeof current);
    memory += extent_of(array).items_offset;
  }
  if (items.count() != 0) {
    std::memcpy(memory, items.items(), items.count() * array.wire_item().size);
  }
}

void complete_packed(RecordTable& table, ElementType number) {
  lay_out(table);
  table.item = {ElementType::void_, static_cast<std::uint32_t>(table.size), nullptr};
  if (table.kind == RecordKind::namedarray) {
    table.number = number;
    table.number_count = static_cast<std::uint32_t>(table.size / item_size(number));
    if (table.number_count == 0) {
      throw Error(ErrorCode::service_definition_error, "`" + table.name + "` holds no numbers");
    }
    table.wire_type =
        std::make_unique<RecordType>(table.name, number, table.number_count, table.operations);
  } else {
    for (const FieldTable& field : table.fields) {
      table.wire_fields.push_back(packed_field(table, field));
    }
    table.wire_type =
        std::make_unique<RecordType>(table.kind, table.name, table.wire_fields, table.operations);
  }
  table.item.record = table.wire_type.get();
  table.value_operations = {table.size, [](void*) {}, [](void*) {}};
  table.array = std::make_unique<ArrayNode>(*table.node, table, ArrayBounds{}, table.name + "[]");
  table.multi_array = std::make_unique<ArrayNode>(*table.node, table, ArrayBounds{.has_dims = true},
                                                  table.name + "[*]");
  table.operations = {&table.value_operations,
                      &table.array->wire_type(),
                      &rr::value_operations<ArrayStorage>,
                      &table.multi_array->wire_type(),
                      &rr::value_operations<value::AnyMultiArray>,
                      table.node.get()};
}

}  // namespace

void complete(RecordTable& table, ElementType number) {
  if (table.kind != RecordKind::struct_) {
    complete_packed(table, number);
    return;
  }
  // The fields of a struct are Values side by side.
  for (std::size_t i = 0; i < table.fields.size(); ++i) {
    check_size(table, (i + 1) * sizeof(Value));
    table.wire_fields.push_back({table.fields[i].name,
                                 static_cast<std::uint32_t>(i * sizeof(Value)), Shortcut::none,
                                 table.fields[i].type, ScalarPrefix()});
  }
  table.wire_type =
      std::make_unique<RecordType>(table.kind, table.name, table.wire_fields, table.operations);
  table.value_operations = rr::value_operations<Value>;
  table.operations = {&table.value_operations, nullptr, nullptr, nullptr, nullptr,
                      table.node.get()};
}

Value unpack(const RecordTable& table, const std::byte* memory) {
  auto content = std::make_shared<RecordContent>();
  content->table = own(table);
  content->fields.reserve(table.fields.size());
  for (const FieldTable& field : table.fields) {
    const std::byte* const place = memory + field.offset;
    if (field.type->kind() == Kind::record) {
      content->fields.push_back(unpack(*field.type->record(), place));
    } else if (field.type->kind() == Kind::array) {
      content->fields.push_back(unpack_array(static_cast<const ArrayNode&>(*field.type), place));
    } else {
      content->fields.emplace_back(Kind::number, field.type->number(), place, nullptr);
    }
  }
  return value_of(Kind::record, std::move(content));
}

void pack(const Value& value, const RecordTable& table, std::byte* memory) {
  const List& fields = content_of<RecordContent>(value).fields;
  for (std::size_t i = 0; i < table.fields.size(); ++i) {
    const FieldTable& field = table.fields[i];
    std::byte* const place = memory + field.offset;
    if (field.type->kind() == Kind::record) {
      pack(fields[i], *field.type->record(), place);
    } else if (field.type->kind() == Kind::array) {
      pack_array(fields[i], static_cast<const ArrayNode&>(*field.type), place);
    } else {
      std::memcpy(place, fields[i].bits(), item_size(field.type->number()));
    }
  }
}

}  // namespace rr::dynamic
