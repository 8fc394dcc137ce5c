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
  /// Types have no state.
  constexpr Type() = default;
  ~Type() = default;
};

/// For the runtime: false for every T, so that only a use fails to compile.
template <class T>
inline constexpr bool has_no_wire_type = false;
/// For the runtime: fails to compile, and says what is missing.
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
  none,               ///< none of the following
  bytes1,             ///< number of 1 byte
  bytes2,             ///< number of 2 bytes
  bytes4,             ///< number of 4 bytes, or an enum
  bytes8,             ///< number of 8 bytes
  boolean,            ///< bool
  text,               ///< std::string
  array,              ///< Array of numbers
  fixed_array,        ///< std::array of numbers
  fixed_multi_array,  ///< FixedMultiArray of anything
};
/// For the runtime: which kind a T is.
template <class T>
inline constexpr Shortcut shortcut_of = Shortcut::none;
/// What the payload of a field with a ScalarPrefix is an array of; void_ for fields without one.
template <class T>
inline constexpr ElementType packed_type_of = ElementType::void_;

/// The number type that `T` is; void_ for everything that is no number.
template <class T>
inline constexpr ElementType number_of = ElementType::void_;
/// `double`
template <>
inline constexpr ElementType number_of<double> = ElementType::double_;
/// `single`
template <>
inline constexpr ElementType number_of<float> = ElementType::single;
/// `int8`
template <>
inline constexpr ElementType number_of<std::int8_t> = ElementType::int8;
/// `uint8`
template <>
inline constexpr ElementType number_of<std::uint8_t> = ElementType::uint8;
/// `int16`
template <>
inline constexpr ElementType number_of<std::int16_t> = ElementType::int16;
/// `uint16`
template <>
inline constexpr ElementType number_of<std::uint16_t> = ElementType::uint16;
/// `int32`
template <>
inline constexpr ElementType number_of<std::int32_t> = ElementType::int32;
/// `uint32`
template <>
inline constexpr ElementType number_of<std::uint32_t> = ElementType::uint32;
/// `int64`
template <>
inline constexpr ElementType number_of<std::int64_t> = ElementType::int64;
/// `uint64`
template <>
inline constexpr ElementType number_of<std::uint64_t> = ElementType::uint64;
/// `bool`: one byte.
template <>
inline constexpr ElementType number_of<bool> = ElementType::bool_;

/// Numbers, bool and complex numbers: what arrays consist of.
template <class T>
concept Number = number_of<T>
!= ElementType::void_;

/// Numbers, bool, complex numbers, and enumerations, which travel as int32 (03, section 4).
class NumberType final : public Type {
 public:
  /// Travels as one item of `number`.
  constexpr explicit NumberType(ElementType number) : number_(number) {}
  [[nodiscard]] ElementType element_type() const override { return number_; }
  void write(Writer& writer, const ElementName& name, const void* value) const override;
  bool read(Decoder& decoder, const Element& element, void* value) const override;

 private:
  ElementType number_;
};

/// std::string; UTF-8 is not checked.
class StringType final : public Type {
 public:
  /// Has no state.
  constexpr StringType() = default;
  [[nodiscard]] ElementType element_type() const override { return ElementType::string; }
  void write(Writer& writer, const ElementName& name, const void* value) const override;
  bool read(Decoder& decoder, const Element& element, void* value) const override;
};

/// For the runtime: how a T travels.
template <class T>
inline constexpr NumberType number_type{number_of<T>};
/// For the runtime: how an enum travels.
template <class T>
inline constexpr NumberType enum_type{ElementType::int32};
/// For the runtime: how a string travels.
inline constexpr StringType string_type;

/// Numbers, bool and complex numbers.
template <Number T>
inline constexpr const Type& type_of<T> = number_type<T>;
/// Enums.
template <class T>
requires std::is_enum_v<T>
inline constexpr const Type& type_of<T> = enum_type<T>;
/// Strings.
template <>
inline constexpr const Type& type_of<std::string> = string_type;

/// For the runtime: the kind of a number of this size in bytes.
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
/// Numbers are copied by their size.
template <Number T>
inline constexpr Shortcut shortcut_of<T> = scalar_shortcut(sizeof(T));
/// Any byte but 0 is read as true.
template <>
inline constexpr Shortcut shortcut_of<bool> = Shortcut::boolean;
/// Enums are copied as four bytes.
template <class T>
requires std::is_enum_v<T>
inline constexpr Shortcut shortcut_of<T> = Shortcut::bytes4;
/// Strings have a kind of their own.
template <>
inline constexpr Shortcut shortcut_of<std::string> = Shortcut::text;

/// A number is an array of one item of its type.
template <Number T>
inline constexpr ElementType packed_type_of<T> = number_of<T>;
/// An enum is an int32.
template <class T>
requires std::is_enum_v<T>
inline constexpr ElementType packed_type_of<T> = ElementType::int32;
/// A string is its bytes.
template <>
inline constexpr ElementType packed_type_of<std::string> = ElementType::string;

}  // namespace rr
