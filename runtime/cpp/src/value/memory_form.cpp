// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/value/memory_form.hpp"

#include <string_view>

#include "runtime/cpp/src/value/items.hpp"

namespace rr::value {
namespace {

// An element of format 2 without its name, type name and payload (01, section 5).
constexpr std::size_t element_size = 16;
// Of the number that an item of an array has for a name.
constexpr std::size_t longest_index = 10;

std::size_t packed_size(const RecordType& pod);

// The payload and type name of an array of so many items.
std::size_t packed_size(const ItemType& item, std::size_t count) {
  if (item.record == nullptr) return count * item.size;
  const RecordType& record = record_of(item);
  if (record.kind() == RecordKind::namedarray) {
    return record.name().size() + element_size + std::string_view("array").size() +
           count * record.number_count() * item_size(record.number_type());
  }
  return record.name().size() + count * packed_size(record);
}

std::size_t packed_size(const Type& type) {
  if (const auto* fixed = dynamic_cast<const FixedArrayType*>(&type)) {
    return packed_size(fixed->item(), fixed->count());
  }
  if (const auto* bounded = dynamic_cast<const BoundedArrayType*>(&type)) {
    return packed_size(bounded->item(), bounded->maximum());
  }
  if (const auto* multi = dynamic_cast<const FixedMultiArrayType*>(&type)) {
    return packed_size(multi->item(), multi->count());
  }
  if (const auto* record = dynamic_cast<const RecordType*>(&type)) {
    return packed_size(ItemType{ElementType::void_, 0, record}, 1);
  }
  return item_size(type.element_type());
}

// One item of a pod array.
std::size_t packed_size(const RecordType& pod) {
  std::size_t size = element_size + longest_index;
  for (const Field& field : pod.fields()) {
    size += element_size + field.name.size() + packed_size(*field.type);
  }
  return size;
}

}  // namespace

MemoryForm memory_form(const Type& type) {
  if (const auto* multi = dynamic_cast<const MultiArrayType*>(&type)) {
    return {true, &multi->item()};
  }
  return {false, &static_cast<const ArrayType&>(type).item()};
}

std::size_t transfer_size(const ItemType& item) {
  if (item.record == nullptr) return item.size;
  const RecordType& record = record_of(item);
  return record.kind() == RecordKind::namedarray ? item_size(record.number_type())
                                                 : packed_size(record);
}

}  // namespace rr::value
