// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <vector>

#include "rr/array_type.hpp"
#include "runtime/cpp/src/value/items.hpp"

// Arrays of several dimensions: an element with `dims` and `array` (03, sections 5, 9 and 10).
namespace rr {
namespace {

using value::AnyMultiArray;
using value::open_items;
using value::ReceivedItems;
using value::record_of;

bool fail_shape(Latch& latch, std::string_view name) {
  return latch.fail(ErrorCode::data_type_error, "dims do not fit", name);
}

// No dims at all are sent for an empty array (03, section 5).
bool is_product(std::span<const std::uint32_t> dims, std::uint64_t count) {
  if (dims.empty() || std::find(dims.begin(), dims.end(), 0U) != dims.end()) return count == 0;
  std::uint64_t product = 1;
  for (const std::uint32_t dim : dims) {
    product *= dim;
    if (product > count) return false;  // before it overflows
  }
  return product == count;
}

void write_with_dims(Writer& writer, const ElementName& name, const ItemType& item,
                     std::span<const std::uint32_t> dims, const void* items, std::size_t count,
                     const MemoryRef& owner) {
  const Descent descent(writer, name.text);
  const std::size_t end = writer.position();
  value::write_items(writer, "array", item, items, count, owner);
  const std::size_t dims_end = writer.position();
  writer.prepend_bytes(dims.data(), dims.size_bytes());
  writer.element("dims", ElementType::uint32, {}, static_cast<std::uint32_t>(dims.size()),
                 dims_end);
  const std::string_view type_name = item.record == nullptr ? "" : record_of(item).name();
  writer.element(name, value::multi_element_type(item), type_name, 2, end);
}

// Finds both parts and checks that they belong together. `dims` holds the bytes of the dims.
bool open_with_dims(Decoder& decoder, const Element& element, const ItemType& item, Element& dims,
                    ReceivedItems& received) {
  if (element.type != value::multi_element_type(item)) return value::fail_type(decoder, element);
  if (item.record != nullptr && element.type_name != record_of(item).name()) {
    return decoder.fail(ErrorCode::data_type_error, "another pod or namedarray than expected",
                        element.name);
  }
  if (!find_element(decoder, element.payload, element.count, "dims", dims)) {
    return decoder.fail(ErrorCode::message_element_not_found, "no such element", "dims");
  }
  if (dims.type != ElementType::uint32) return value::fail_type(decoder, dims);
  Element array;
  if (!find_element(decoder, element.payload, element.count, "array", array)) {
    return decoder.fail(ErrorCode::message_element_not_found, "no such element", "array");
  }
  return open_items(decoder, array, item, received);
}

bool has_shape(const Element& dims, std::span<const std::uint32_t> shape) {
  return dims.payload.size() == shape.size_bytes() &&
         std::memcmp(dims.payload.data(), shape.data(), shape.size_bytes()) == 0;
}

}  // namespace

ElementType MultiArrayType::element_type() const { return value::multi_element_type(*item_); }

void MultiArrayType::write(Writer& writer, const ElementName& name, const void* value) const {
  const auto& array = *static_cast<const AnyMultiArray*>(value);
  const bool fits = shape_.empty() ||
                    std::equal(shape_.begin(), shape_.end(), array.dims.begin(), array.dims.end());
  if (!fits || !is_product(array.dims, array.items.count())) fail_shape(writer, name.text);
  write_with_dims(writer, name, *item_, array.dims, array.items.items(), array.items.count(),
                  array.items.owner());
}

bool MultiArrayType::read(Decoder& decoder, const Element& element, void* value) const {
  auto& array = *static_cast<AnyMultiArray*>(value);
  Element dims;
  ReceivedItems received;
  if (!open_with_dims(decoder, element, *item_, dims, received)) return false;
  if (!shape_.empty() && !has_shape(dims, shape_)) return fail_shape(decoder, element.name);
  array.dims.resize(dims.count);
  if (dims.count != 0) std::memcpy(array.dims.data(), dims.payload.data(), dims.payload.size());
  if (!is_product(array.dims, received.count)) return fail_shape(decoder, element.name);
  return value::read_array(decoder, received, *item_, array.items);
}

ElementType FixedMultiArrayType::element_type() const { return value::multi_element_type(*item_); }

void FixedMultiArrayType::write(Writer& writer, const ElementName& name, const void* value) const {
  write_with_dims(writer, name, *item_, shape_, value, count_, {});
}

bool FixedMultiArrayType::read(Decoder& decoder, const Element& element, void* value) const {
  Element dims;
  ReceivedItems received;
  if (!open_with_dims(decoder, element, *item_, dims, received)) return false;
  if (!has_shape(dims, shape_) || received.count != count_) {
    return fail_shape(decoder, element.name);
  }
  return value::read_items(decoder, received, *item_, value);
}

void FixedMultiArrayType::write_flat(Writer& writer, const ElementName& name,
                                     const void* value) const {
  value::write_items(writer, name, *item_, value, count_, {});
}

bool FixedMultiArrayType::read_flat(Decoder& decoder, const Element& element, void* value) const {
  ReceivedItems received;
  if (!open_items(decoder, element, *item_, received)) return false;
  if (received.count != count_) {
    return decoder.fail(ErrorCode::data_type_error, "wrong number of items", element.name);
  }
  return value::read_items(decoder, received, *item_, value);
}

}  // namespace rr
