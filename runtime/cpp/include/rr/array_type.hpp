// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "rr/array.hpp"
#include "rr/type_of.hpp"
#include "rr/visibility.hpp"

/// How the array forms of rr/array.hpp travel.
namespace RR_VISIBLE rr {

/// What an array consists of: numbers, or items of a pod or namedarray.
struct ItemType {
  ElementType number;  ///< void_ for pods and namedarrays
  std::uint32_t size;  ///< bytes
  const Type* record;  ///< a RecordType; null for numbers
};

/// For generated code: the ItemType of a number, pod or namedarray.
template <class T>
constexpr ItemType make_item_type() {
  if constexpr (Number<T>) {
    return {number_of<T>, sizeof(T), nullptr};
  } else {
    return {ElementType::void_, sizeof(T), &type_of<T>};
  }
}
/// For generated code: what an array of T consists of.
template <class T>
inline constexpr ItemType item_type = make_item_type<T>();

/// Array<T>, of any or of a bounded length.
class ArrayType final : public Type {
 public:
  /// An array of `minimum` to `maximum` items.
  constexpr ArrayType(const ItemType& item, std::uint32_t minimum, std::uint32_t maximum)
      : item_(&item), minimum_(minimum), maximum_(maximum) {}
  /// What the array consists of.
  [[nodiscard]] const ItemType& item() const { return *item_; }
  /// Whether an array may have so many items.
  [[nodiscard]] bool takes(std::size_t count) const {
    return count >= minimum_ && count <= maximum_;
  }

  [[nodiscard]] ElementType element_type() const override;
  void write(Writer& writer, const ElementName& name, const void* value) const override;
  bool read(Decoder& decoder, const Element& element, void* value) const override;

 private:
  const ItemType* item_;
  std::uint32_t minimum_;
  std::uint32_t maximum_;
};

/// std::array<T, n>.
class FixedArrayType final : public Type {
 public:
  /// An array of exactly `count` items.
  constexpr FixedArrayType(const ItemType& item, std::uint32_t count)
      : item_(&item), count_(count) {}
  /// What the array consists of.
  [[nodiscard]] const ItemType& item() const { return *item_; }
  /// Number of items.
  [[nodiscard]] std::uint32_t count() const { return count_; }

  [[nodiscard]] ElementType element_type() const override;
  void write(Writer& writer, const ElementName& name, const void* value) const override;
  bool read(Decoder& decoder, const Element& element, void* value) const override;

 private:
  const ItemType* item_;
  std::uint32_t count_;
};

/// BoundedArray<T, n>.
class BoundedArrayType final : public Type {
 public:
  /// At most `maximum` items, which lie `offset` bytes from the beginning of the BoundedArray.
  constexpr BoundedArrayType(const ItemType& item, std::uint32_t maximum, std::uint32_t offset)
      : item_(&item), maximum_(maximum), offset_(offset) {}
  /// What the array consists of.
  [[nodiscard]] const ItemType& item() const { return *item_; }
  /// The most items that there may be.
  [[nodiscard]] std::uint32_t maximum() const { return maximum_; }

  [[nodiscard]] ElementType element_type() const override;
  void write(Writer& writer, const ElementName& name, const void* value) const override;
  bool read(Decoder& decoder, const Element& element, void* value) const override;

 private:
  const ItemType* item_;
  std::uint32_t maximum_;
  std::uint32_t offset_;  ///< of the items in the BoundedArray
};

/// MultiArray<T>, of any shape or of one.
class MultiArrayType final : public Type {
 public:
  /// An array of this shape, or of any when there is none. The shape must outlive the type.
  constexpr explicit MultiArrayType(const ItemType& item, std::span<const std::uint32_t> shape = {})
      : item_(&item), shape_(shape) {}
  /// What the array consists of.
  [[nodiscard]] const ItemType& item() const { return *item_; }

  [[nodiscard]] ElementType element_type() const override;
  void write(Writer& writer, const ElementName& name, const void* value) const override;
  bool read(Decoder& decoder, const Element& element, void* value) const override;

 private:
  const ItemType* item_;
  std::span<const std::uint32_t> shape_;  ///< empty for any
};

/// FixedMultiArray<T, m, n>. In pods it has a form of its own, without dims (03, section 9).
class FixedMultiArrayType final : public Type {
 public:
  /// An array of this shape, which has `count` items. The shape must outlive the type.
  constexpr FixedMultiArrayType(const ItemType& item, std::span<const std::uint32_t> shape,
                                std::uint32_t count)
      : item_(&item), shape_(shape), count_(count) {}
  /// What the array consists of.
  [[nodiscard]] const ItemType& item() const { return *item_; }
  /// Number of items: the product of the shape.
  [[nodiscard]] std::uint32_t count() const { return count_; }

  [[nodiscard]] ElementType element_type() const override;
  void write(Writer& writer, const ElementName& name, const void* value) const override;
  bool read(Decoder& decoder, const Element& element, void* value) const override;
  /// Writes it as it is in a pod: the items, without dims.
  void write_flat(Writer& writer, const ElementName& name, const void* value) const;
  /// Reads it as it is in a pod: the items, without dims. False when the decoder has failed.
  bool read_flat(Decoder& decoder, const Element& element, void* value) const;

 private:
  const ItemType* item_;
  std::span<const std::uint32_t> shape_;
  std::uint32_t count_;
};

/// An Array<T> of exactly `Length` items, for lengths that are too large to be stored in place. A
/// name for type_of and field only; the C++ type of the value is the plain Array.
template <class T, std::uint32_t Length>
struct FixedLength;
/// An Array<T> of at most `Length` items. A name for type_of and field, as FixedLength.
template <class T, std::uint32_t Length>
struct MaximumLength;
/// A MultiArray<T> of exactly this shape. A name for type_of and field, as FixedLength.
template <class T, std::uint32_t... Dims>
struct FixedShape;

/// No limit to the number of items of an ArrayType.
inline constexpr std::uint32_t any_length = std::numeric_limits<std::uint32_t>::max();
/// For generated code: a shape as a constant.
template <std::uint32_t... Dims>
inline constexpr std::array<std::uint32_t, sizeof...(Dims)> shape_of{Dims...};

/// For generated code: how an Array of so many items travels.
template <class T, std::uint32_t Minimum, std::uint32_t Maximum>
inline constexpr ArrayType array_type{item_type<T>, Minimum, Maximum};
/// For generated code: how a std::array travels.
template <class T, std::size_t Length>
inline constexpr FixedArrayType fixed_array_type{item_type<T>, Length};
/// For generated code: how a BoundedArray travels.
template <class T, std::size_t Maximum>
inline constexpr BoundedArrayType bounded_array_type{item_type<T>, Maximum,
                                                     BoundedArray<T, Maximum>::items_offset};
/// For generated code: how a MultiArray of this shape travels.
template <class T, std::uint32_t... Dims>
inline constexpr MultiArrayType multi_array_type{item_type<T>, shape_of<Dims...>};
/// For generated code: how a MultiArray of any shape travels.
template <class T>
inline constexpr MultiArrayType multi_array_type<T>{item_type<T>};
/// For generated code: how a FixedMultiArray travels.
template <class T, std::size_t... Dims>
inline constexpr FixedMultiArrayType fixed_multi_array_type{
    item_type<T>, FixedMultiArray<T, Dims...>::dims, (static_cast<std::uint32_t>(Dims) * ...)};

/// `T[]`: an array of any length.
template <class T>
inline constexpr const Type& type_of<Array<T>> = array_type<T, 0, any_length>;
/// `T[n]`, too large to be stored in place.
template <class T, std::uint32_t Length>
inline constexpr const Type& type_of<FixedLength<T, Length>> = array_type<T, Length, Length>;
/// `T[n-]`, too large to be stored in place.
template <class T, std::uint32_t Length>
inline constexpr const Type& type_of<MaximumLength<T, Length>> = array_type<T, 0, Length>;
/// `T[n]`: exactly so many items.
template <class T, std::size_t Length>
inline constexpr const Type& type_of<std::array<T, Length>> = fixed_array_type<T, Length>;
/// `T[n-]`: at most so many items.
template <class T, std::size_t Maximum>
inline constexpr const Type& type_of<BoundedArray<T, Maximum>> = bounded_array_type<T, Maximum>;
/// `T[*]`: any number of dimensions.
template <class T>
inline constexpr const Type& type_of<MultiArray<T>> = multi_array_type<T>;
/// `T[m,n]`, too large to be stored in place.
template <class T, std::uint32_t... Dims>
inline constexpr const Type& type_of<FixedShape<T, Dims...>> = multi_array_type<T, Dims...>;
/// `T[m,n]`: exactly this shape.
template <class T, std::size_t... Dims>
inline constexpr const Type& type_of<FixedMultiArray<T, Dims...>> =
    fixed_multi_array_type<T, Dims...>;

/// For generated code: arrays of numbers are read and written without a virtual call.
template <Number T>
inline constexpr Shortcut shortcut_of<Array<T>> = Shortcut::array;
/// For generated code: as an array of numbers.
template <Number T, std::uint32_t Length>
inline constexpr Shortcut shortcut_of<FixedLength<T, Length>> = Shortcut::array;
/// For generated code: as an array of numbers.
template <Number T, std::uint32_t Length>
inline constexpr Shortcut shortcut_of<MaximumLength<T, Length>> = Shortcut::array;
/// For generated code: numbers in place.
template <Number T, std::size_t Length>
inline constexpr Shortcut shortcut_of<std::array<T, Length>> = Shortcut::fixed_array;
/// For generated code: numbers in place, with dims.
template <class T, std::size_t... Dims>
inline constexpr Shortcut shortcut_of<FixedMultiArray<T, Dims...>> = Shortcut::fixed_multi_array;

/// For generated code: the element type of the numbers.
template <Number T>
inline constexpr ElementType packed_type_of<Array<T>> = number_of<T>;
/// For generated code: the element type of the numbers.
template <Number T, std::uint32_t Length>
inline constexpr ElementType packed_type_of<FixedLength<T, Length>> = number_of<T>;
/// For generated code: the element type of the numbers.
template <Number T, std::uint32_t Length>
inline constexpr ElementType packed_type_of<MaximumLength<T, Length>> = number_of<T>;
/// For generated code: the element type of the numbers.
template <Number T, std::size_t Length>
inline constexpr ElementType packed_type_of<std::array<T, Length>> = number_of<T>;

}  // namespace rr
