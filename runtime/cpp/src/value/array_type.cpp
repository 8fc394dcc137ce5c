// SPDX-License-Identifier: Apache-2.0
#include "rr/array_type.hpp"

#include "runtime/cpp/src/value/items.hpp"

namespace rr {
namespace {

using value::open_items;
using value::read_items;
using value::ReceivedItems;

bool fail_length(Latch& latch, std::string_view name) {
  return latch.fail(ErrorCode::data_type_error, "wrong number of items", name);
}

// Reads exactly `count` items into place.
bool read_in_place(Decoder& decoder, const Element& element, const ItemType& item,
                   std::uint32_t count, void* items) {
  ReceivedItems received;
  if (!open_items(decoder, element, item, received)) return false;
  if (received.count != count) return fail_length(decoder, element.name);
  return read_items(decoder, received, item, items);
}

}  // namespace

ElementType ArrayType::element_type() const { return value::element_type(*item_); }

void ArrayType::write(Writer& writer, const ElementName& name, const void* value) const {
  const auto& array = *static_cast<const ArrayStorage*>(value);
  if (!takes(array.count())) fail_length(writer, name.text);
  value::write_items(writer, name, *item_, array.items(), array.count(), array.owner());
}

bool ArrayType::read(Decoder& decoder, const Element& element, void* value) const {
  ReceivedItems received;
  if (!open_items(decoder, element, *item_, received)) return false;
  if (!takes(received.count)) return fail_length(decoder, element.name);
  return value::read_array(decoder, received, *item_, *static_cast<ArrayStorage*>(value));
}

ElementType FixedArrayType::element_type() const { return value::element_type(*item_); }

[[gnu::hot]] void FixedArrayType::write(Writer& writer, const ElementName& name,
                                        const void* value) const {
  value::write_items(writer, name, *item_, value, count_, {});
}

[[gnu::hot]] bool FixedArrayType::read(Decoder& decoder, const Element& element,
                                       void* value) const {
  return read_in_place(decoder, element, *item_, count_, value);
}

ElementType BoundedArrayType::element_type() const { return value::element_type(*item_); }

void BoundedArrayType::write(Writer& writer, const ElementName& name, const void* value) const {
  const std::uint32_t count = *static_cast<const std::uint32_t*>(value);
  value::write_items(writer, name, *item_, static_cast<const std::byte*>(value) + offset_, count,
                     {});
}

bool BoundedArrayType::read(Decoder& decoder, const Element& element, void* value) const {
  ReceivedItems received;
  if (!open_items(decoder, element, *item_, received)) return false;
  if (received.count > maximum_) return fail_length(decoder, element.name);
  *static_cast<std::uint32_t*>(value) = received.count;
  return read_items(decoder, received, *item_, static_cast<std::byte*>(value) + offset_);
}

}  // namespace rr
