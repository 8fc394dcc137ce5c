// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/value/items.hpp"

#include <algorithm>
#include <cstring>

namespace rr::value {
namespace {

// Below this a copy is cheaper than keeping the whole received message alive.
constexpr std::size_t slice_threshold = 4096;
// What counts the references to an array's items.
constexpr std::size_t array_cost = allocation_cost + 32;

ElementType packed_type(const ItemType& item) {
  return item.record == nullptr ? item.number : record_of(item).number_type();
}

// A complex number is aligned as its parts are.
std::size_t alignment_of(ElementType number) {
  const std::size_t size = item_size(number);
  return number == ElementType::cdouble || number == ElementType::csingle ? size / 2 : size;
}

bool is_aligned(const void* address, std::size_t alignment) {
  return reinterpret_cast<std::uintptr_t>(address) % alignment == 0;
}

void write_pods(Writer& writer, const RecordType& pod, const void* items, std::size_t count) {
  const Descent descent(writer, {});
  const std::size_t size = pod.operations().value->size;
  const auto* item = static_cast<const std::byte*>(items) + size * count;
  for (std::size_t i = count; i-- > 0;) {
    item -= size;
    const std::size_t end = writer.position();
    pod.write_fields(writer, item);
    writer.element(ElementName(static_cast<std::int32_t>(i)), ElementType::pod, {},
                   static_cast<std::uint32_t>(pod.fields().size()), end);
  }
}

bool read_pods(Decoder& decoder, const Element& list, const RecordType& pod, void* items) {
  const std::size_t size = pod.operations().value->size;
  auto* item = static_cast<std::byte*>(items);
  ElementReader reader(decoder, list);
  Element element;
  for (std::uint32_t i = 0; i < list.count; ++i, item += size) {
    if (!reader.next(element)) return false;
    if (element.index() != static_cast<std::int32_t>(i)) {
      return decoder.fail(ErrorCode::data_type_error, "items of a pod array out of order",
                          list.name);
    }
    if (element.type != ElementType::pod) return fail_type(decoder, element);
    if (!pod.read_fields(decoder, element, item)) return false;
  }
  return true;
}

bool open_pods(Decoder& decoder, const Element& element, const RecordType& pod,
               ReceivedItems& received) {
  if (element.type != ElementType::pod_array) return fail_type(decoder, element);
  if (element.type_name != pod.name()) {
    return decoder.fail(ErrorCode::data_type_error, "another pod than expected", element.name);
  }
  received.element = element;
  received.count = element.count;
  return true;
}

bool open_namedarrays(Decoder& decoder, const Element& element, const RecordType& namedarray,
                      ReceivedItems& received) {
  if (element.type != ElementType::namedarray_array) return fail_type(decoder, element);
  if (element.type_name != namedarray.name()) {
    return decoder.fail(ErrorCode::data_type_error, "another namedarray than expected",
                        element.name);
  }
  if (!find_element(decoder, element.payload, element.count, "array", received.element)) {
    return decoder.fail(ErrorCode::message_element_not_found, "namedarray without `array`",
                        element.name);
  }
  if (received.element.type != namedarray.number_type())
    return fail_type(decoder, received.element);
  if (received.element.count % namedarray.number_count() != 0) {
    return decoder.fail(ErrorCode::data_type_error, "part of a namedarray", element.name);
  }
  received.count = received.element.count / namedarray.number_count();
  return true;
}

}  // namespace

bool fail_type(Decoder& decoder, const Element& element) {
  if (element.type == ElementType::void_) {
    return decoder.fail(ErrorCode::null_value, "null where a value must be", element.name);
  }
  return decoder.fail(ErrorCode::data_type_mismatch, "another type than expected", element.name);
}

ElementType element_type(const ItemType& item) {
  return item.record == nullptr ? item.number : item.record->element_type();
}

ElementType multi_element_type(const ItemType& item) {
  if (item.record == nullptr) return ElementType::multidimarray;
  return record_of(item).kind() == RecordKind::namedarray ? ElementType::namedarray_multidimarray
                                                          : ElementType::pod_multidimarray;
}

void write_items(Writer& writer, const ElementName& name, const ItemType& item, const void* items,
                 std::size_t count, const MemoryRef& owner) {
  const std::size_t end = writer.position();
  const auto size = static_cast<std::uint32_t>(count);  // a larger one fails in element()
  const std::span packed(static_cast<const std::byte*>(items), count * item.size);
  if (item.record == nullptr) {
    writer.prepend_array(packed, owner);
    writer.element(name, item.number, {}, size, end);
    return;
  }
  const Descent descent(writer, name.text);
  const RecordType& record = record_of(item);
  if (record.kind() == RecordKind::namedarray) {
    writer.prepend_array(packed, owner);
    writer.element("array", record.number_type(), {}, size * record.number_count(), end);
    writer.element(name, ElementType::namedarray_array, record.name(), 1, end);
  } else {
    write_pods(writer, record, items, count);
    writer.element(name, ElementType::pod_array, record.name(), size, end);
  }
}

bool open_items(Decoder& decoder, const Element& element, const ItemType& item,
                ReceivedItems& received) {
  if (item.record != nullptr) {
    const RecordType& record = record_of(item);
    return record.kind() == RecordKind::namedarray
               ? open_namedarrays(decoder, element, record, received)
               : open_pods(decoder, element, record, received);
  }
  if (element.type != item.number) return fail_type(decoder, element);
  received.element = element;
  received.count = element.count;
  return true;
}

[[gnu::hot]] bool read_items(Decoder& decoder, const ReceivedItems& received, const ItemType& item,
                             void* items) {
  if (received.count == 0) return true;
  const ElementType number = packed_type(item);
  if (number == ElementType::void_) {
    return read_pods(decoder, received.element, record_of(item), items);
  }
  const std::span<const std::byte> packed = decoder.locate(received.element.payload).items;
  if (number == ElementType::bool_) {
    copy_bools(static_cast<std::byte*>(items), packed.data(), packed.size());
  } else {
    std::memcpy(items, packed.data(), packed.size());
  }
  return true;
}

bool read_array(Decoder& decoder, const ReceivedItems& received, const ItemType& item,
                ArrayStorage& array) {
  const ElementType number = packed_type(item);
  const auto [packed, owner, is_displaced] = decoder.locate(received.element.payload);
  if (number != ElementType::void_ && packed.size() >= slice_threshold && owner != nullptr &&
      is_aligned(packed.data(), alignment_of(number)) &&
      (number != ElementType::bool_ ||
       (!is_displaced && !has_odd_bools(packed.data(), packed.size())))) {
    array.share(packed.data(), received.count, *owner);
    return true;
  }
  const std::size_t bytes = std::size_t{received.count} * item.size;
  if (number == ElementType::void_) {
    if (!decoder.reserve(bytes + array_cost, received.element.name)) return false;
    std::byte* room = array.make_room(received.count, item.size);
    // Pods are implicitly made by their bytes; all zero is an empty one.
    if (bytes != 0) std::memset(room, 0, bytes);
    return read_items(decoder, received, item, room);
  }
  decoder.count_copied_array(bytes);
  if (bytes != 0 && !decoder.reserve(bytes + array_cost, received.element.name)) return false;
  return read_items(decoder, received, item, array.make_room(received.count, item.size));
}

bool has_odd_bools(const std::byte* bytes, std::size_t count) {
  return std::any_of(bytes, bytes + count, [](std::byte byte) { return byte > std::byte{1}; });
}

void copy_bools(std::byte* to, const std::byte* bytes, std::size_t count) {
  std::transform(bytes, bytes + count, to,
                 [](std::byte byte) { return byte == std::byte{0} ? std::byte{0} : std::byte{1}; });
}

}  // namespace rr::value
