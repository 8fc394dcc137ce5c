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

template <class T>
constexpr ItemType make_item_type() {
  if constexpr (Number<T>) {
    return {number_of<T>, sizeof(T), nullptr};
  } else {
    return {ElementType::void_, sizeof(T), &type_of<T>};
  }
}
template <class T>
inline constexpr ItemType item_type = make_item_type<T>();

/// Array<T>, of any or of a bounded length.
class ArrayType final : public Type {
 public:
  constexpr ArrayType(const ItemType& item, std::uint32_t minimum, std::uint32_t maximum)
      : item_(&item), minimum_(minimum), maximum_(maximum) {}
  [[nodiscard]] const ItemType& item() const { return *item_; }
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
  constexpr FixedArrayType(const ItemType& item, std::uint32_t count)
      : item_(&item), count_(count) {}
  [[nodiscard]] const ItemType& item() const { return *item_; }
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
  constexpr BoundedArrayType(const ItemType& item, std::uint32_t maximum, std::uint32_t offset)
      : item_(&item), maximum_(maximum), offset_(offset) {}
  [[nodiscard]] const ItemType& item() const { return *item_; }
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
  constexpr explicit MultiArrayType(const ItemType& item, std::span<const std::uint32_t> shape = {})
      : item_(&item), shape_(shape) {}
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
  constexpr FixedMultiArrayType(const ItemType& item, std::span<const std::uint32_t> shape,
                                std::uint32_t count)
      : item_(&item), shape_(shape), count_(count) {}
  [[nodiscard]] const ItemType& item() const { return *item_; }
  [[nodiscard]] std::uint32_t count() const { return count_; }

  [[nodiscard]] ElementType element_type() const override;
  void write(Writer& writer, const ElementName& name, const void* value) const override;
  bool read(Decoder& decoder, const Element& element, void* value) const override;
  void write_flat(Writer& writer, const ElementName& name, const void* value) const;
  bool read_flat(Decoder& decoder, const Element& element, void* value) const;

 private:
  const ItemType* item_;
  std::span<const std::uint32_t> shape_;
  std::uint32_t count_;
};

/// An Array<T> of exactly, or at most, so many items; a MultiArray<T> of exactly this shape: for
/// lengths that are too large to be stored in place. Names for type_of and field only; the C++ type
/// of the value is the plain Array or MultiArray.
template <class T, std::uint32_t Length>
struct FixedLength;
template <class T, std::uint32_t Length>
struct MaximumLength;
template <class T, std::uint32_t... Dims>
struct FixedShape;

inline constexpr std::uint32_t any_length = std::numeric_limits<std::uint32_t>::max();
template <std::uint32_t... Dims>
inline constexpr std::array<std::uint32_t, sizeof...(Dims)> shape_of{Dims...};

template <class T, std::uint32_t Minimum, std::uint32_t Maximum>
inline constexpr ArrayType array_type{item_type<T>, Minimum, Maximum};
template <class T, std::size_t Length>
inline constexpr FixedArrayType fixed_array_type{item_type<T>, Length};
template <class T, std::size_t Maximum>
inline constexpr BoundedArrayType bounded_array_type{item_type<T>, Maximum,
                                                     BoundedArray<T, Maximum>::items_offset};
template <class T, std::uint32_t... Dims>
inline constexpr MultiArrayType multi_array_type{item_type<T>, shape_of<Dims...>};
template <class T>
inline constexpr MultiArrayType multi_array_type<T>{item_type<T>};
template <class T, std::size_t... Dims>
inline constexpr FixedMultiArrayType fixed_multi_array_type{
    item_type<T>, FixedMultiArray<T, Dims...>::dims, (static_cast<std::uint32_t>(Dims) * ...)};

template <class T>
inline constexpr const Type& type_of<Array<T>> = array_type<T, 0, any_length>;
template <class T, std::uint32_t Length>
inline constexpr const Type& type_of<FixedLength<T, Length>> = array_type<T, Length, Length>;
template <class T, std::uint32_t Length>
inline constexpr const Type& type_of<MaximumLength<T, Length>> = array_type<T, 0, Length>;
template <class T, std::size_t Length>
inline constexpr const Type& type_of<std::array<T, Length>> = fixed_array_type<T, Length>;
template <class T, std::size_t Maximum>
inline constexpr const Type& type_of<BoundedArray<T, Maximum>> = bounded_array_type<T, Maximum>;
template <class T>
inline constexpr const Type& type_of<MultiArray<T>> = multi_array_type<T>;
template <class T, std::uint32_t... Dims>
inline constexpr const Type& type_of<FixedShape<T, Dims...>> = multi_array_type<T, Dims...>;
template <class T, std::size_t... Dims>
inline constexpr const Type& type_of<FixedMultiArray<T, Dims...>> =
    fixed_multi_array_type<T, Dims...>;

template <Number T>
inline constexpr Shortcut shortcut_of<Array<T>> = Shortcut::array;
template <Number T, std::uint32_t Length>
inline constexpr Shortcut shortcut_of<FixedLength<T, Length>> = Shortcut::array;
template <Number T, std::uint32_t Length>
inline constexpr Shortcut shortcut_of<MaximumLength<T, Length>> = Shortcut::array;
template <Number T, std::size_t Length>
inline constexpr Shortcut shortcut_of<std::array<T, Length>> = Shortcut::fixed_array;
template <class T, std::size_t... Dims>
inline constexpr Shortcut shortcut_of<FixedMultiArray<T, Dims...>> = Shortcut::fixed_multi_array;

template <Number T>
inline constexpr ElementType packed_type_of<Array<T>> = number_of<T>;
template <Number T, std::uint32_t Length>
inline constexpr ElementType packed_type_of<FixedLength<T, Length>> = number_of<T>;
template <Number T, std::uint32_t Length>
inline constexpr ElementType packed_type_of<MaximumLength<T, Length>> = number_of<T>;
template <Number T, std::size_t Length>
inline constexpr ElementType packed_type_of<std::array<T, Length>> = number_of<T>;

}  // namespace rr
