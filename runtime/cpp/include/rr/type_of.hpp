// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>

#include "rr/reader.hpp"
#include "rr/visibility.hpp"
#include "rr/wire.hpp"
#include "rr/writer.hpp"

/// How one C++ type is found to travel. The types themselves are in rr/type.hpp.
namespace RR_VISIBLE rr {

/// Reads and writes values of one C++ type. Constants without state; compared by address.
class Type {
 public:
  /// What elements of this type hold; void_ for varvalue.
  [[nodiscard]] virtual ElementType element_type() const = 0;
  /// Writes one whole element (before what was written so far). What may not be sent (a wrong
  /// length) fails the writer.
  virtual void write(Writer& writer, const ElementName& name, const void* value) const = 0;
  /// Assigns what the element holds. False, with the decoder failed, when it does not fit; the
  /// value is then in no certain state. Memory that the value already has is used again.
  virtual bool read(Decoder& decoder, const Element& element, void* value) const = 0;

 protected:
  constexpr Type() = default;
  ~Type() = default;
};

template <class T>
inline constexpr bool has_no_wire_type = false;
template <class T>
constexpr const Type& missing_type() {
  static_assert(has_no_wire_type<T>,
                "the protocol has no such type: see the table in rr/type.hpp; std::complex needs "
                "rr/complex.hpp, a struct of a definition the header generated for it");
  return missing_type<T>();
}

/// The description of `T`. Generated code specializes it for the types of a definition.
template <class T>
inline constexpr const Type& type_of = missing_type<T>();

/// Which of the frequent kinds a field's type is, so that loops over fields need no virtual call.
enum class Shortcut : std::uint8_t {
  none,
  bytes1,
  bytes2,
  bytes4,
  bytes8,
  boolean,
  text,
  array,              ///< Array of numbers
  fixed_array,        ///< std::array of numbers
  fixed_multi_array,  ///< FixedMultiArray of anything
};
template <class T>
inline constexpr Shortcut shortcut_of = Shortcut::none;
/// What the payload of a field with a ScalarPrefix is an array of; void_ for fields without one.
template <class T>
inline constexpr ElementType packed_type_of = ElementType::void_;

/// The number type that `T` is; void_ for everything that is no number.
template <class T>
inline constexpr ElementType number_of = ElementType::void_;
template <>
inline constexpr ElementType number_of<double> = ElementType::double_;
template <>
inline constexpr ElementType number_of<float> = ElementType::single;
template <>
inline constexpr ElementType number_of<std::int8_t> = ElementType::int8;
template <>
inline constexpr ElementType number_of<std::uint8_t> = ElementType::uint8;
template <>
inline constexpr ElementType number_of<std::int16_t> = ElementType::int16;
template <>
inline constexpr ElementType number_of<std::uint16_t> = ElementType::uint16;
template <>
inline constexpr ElementType number_of<std::int32_t> = ElementType::int32;
template <>
inline constexpr ElementType number_of<std::uint32_t> = ElementType::uint32;
template <>
inline constexpr ElementType number_of<std::int64_t> = ElementType::int64;
template <>
inline constexpr ElementType number_of<std::uint64_t> = ElementType::uint64;
template <>
inline constexpr ElementType number_of<bool> = ElementType::bool_;

template <class T>
concept Number = number_of<T>
!= ElementType::void_;

/// Numbers, bool, complex numbers, and enumerations, which travel as int32 (03, section 4).
class NumberType final : public Type {
 public:
  constexpr explicit NumberType(ElementType number) : number_(number) {}
  [[nodiscard]] ElementType element_type() const override { return number_; }
  void write(Writer& writer, const ElementName& name, const void* value) const override;
  bool read(Decoder& decoder, const Element& element, void* value) const override;

 private:
  ElementType number_;
};

class StringType final : public Type {
 public:
  constexpr StringType() = default;
  [[nodiscard]] ElementType element_type() const override { return ElementType::string; }
  void write(Writer& writer, const ElementName& name, const void* value) const override;
  bool read(Decoder& decoder, const Element& element, void* value) const override;
};

template <class T>
inline constexpr NumberType number_type{number_of<T>};
template <class T>
inline constexpr NumberType enum_type{ElementType::int32};
inline constexpr StringType string_type;

template <Number T>
inline constexpr const Type& type_of<T> = number_type<T>;
template <class T>
requires std::is_enum_v<T>
inline constexpr const Type& type_of<T> = enum_type<T>;
template <>
inline constexpr const Type& type_of<std::string> = string_type;

constexpr Shortcut scalar_shortcut(std::size_t size) {
  switch (size) {
    case 1:
      return Shortcut::bytes1;
    case 2:
      return Shortcut::bytes2;
    case 4:
      return Shortcut::bytes4;
    case 8:
      return Shortcut::bytes8;
    default:
      return Shortcut::none;
  }
}
template <Number T>
inline constexpr Shortcut shortcut_of<T> = scalar_shortcut(sizeof(T));
template <>
inline constexpr Shortcut shortcut_of<bool> = Shortcut::boolean;
template <class T>
requires std::is_enum_v<T>
inline constexpr Shortcut shortcut_of<T> = Shortcut::bytes4;
template <>
inline constexpr Shortcut shortcut_of<std::string> = Shortcut::text;

template <Number T>
inline constexpr ElementType packed_type_of<T> = number_of<T>;
template <class T>
requires std::is_enum_v<T>
inline constexpr ElementType packed_type_of<T> = ElementType::int32;
template <>
inline constexpr ElementType packed_type_of<std::string> = ElementType::string;

}  // namespace rr
