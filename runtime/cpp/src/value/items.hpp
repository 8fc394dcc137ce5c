// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "rr/array_type.hpp"
#include "rr/record.hpp"
#include "rr/visibility.hpp"

/// What all array forms, and single pods and namedarrays, have in common: a number of items in
/// memory, and the element that they travel in (03, sections 4, 9 and 10).
namespace rr::value {

inline const RecordType& record_of(const ItemType& item) {
  return *static_cast<const RecordType*>(item.record);
}

/// A MultiArray<T> of any T.
struct AnyMultiArray {
  std::vector<std::uint32_t> dims;
  ArrayStorage items;
};
static_assert(sizeof(AnyMultiArray) == sizeof(MultiArray<double>));

/// What a value that is allocated by itself takes besides its bytes, about.
inline constexpr std::size_t allocation_cost = 24;

/// Fails the decoder for an element of another type than `expected`: null is an error of its own.
RR_INSIDE bool fail_type(Decoder& decoder, const Element& element);

/// What elements of such items are: the number type, or pod_array, or namedarray_array.
ElementType element_type(const ItemType& item);
/// The same for an element with dims.
ElementType multi_element_type(const ItemType& item);

/// Writes the element of an array of `count` items. With an owner, or when large, they may be
/// attached instead of copied.
RR_INSIDE void write_items(Writer& writer, const ElementName& name, const ItemType& item,
                           const void* items, std::size_t count, const MemoryRef& owner);

/// An element of an array whose type was found to be right.
struct ReceivedItems {
  std::uint32_t count = 0;
  Element element;  ///< its payload is the numbers, or the pods
};
bool open_items(Decoder& decoder, const Element& element, const ItemType& item,
                ReceivedItems& received);
/// Copies into constructed items.
bool read_items(Decoder& decoder, const ReceivedItems& received, const ItemType& item, void* items);
/// Slices or copies into an Array.
bool read_array(Decoder& decoder, const ReceivedItems& received, const ItemType& item,
                ArrayStorage& array);
/// Whether a bool array has bytes other than 0 and 1, which C++ does not allow in memory.
bool has_odd_bools(const std::byte* bytes, std::size_t count);
void copy_bools(std::byte* to, const std::byte* bytes, std::size_t count);

}  // namespace rr::value
