// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "rr/buffer.hpp"
#include "rr/error.hpp"
#include "rr/type.hpp"
#include "rr/visibility.hpp"

namespace RR_VISIBLE rr {

class VarValue;
/// What containers inside a varvalue hold, whatever their sender's item type was (03, section 8).
using VarList = std::vector<VarValue>;
/// What a map with int32 keys inside a varvalue holds.
using VarIntMap = std::map<std::int32_t, VarValue>;
/// What a map with string keys inside a varvalue holds; attributes and credentials.
using VarStringMap = std::map<std::string, VarValue>;

/// Any value of the protocol, or null. Cheap to copy: copies share the value, which does not
/// change, so that they may be used by several threads at once.
///
/// A received one holds what the bytes tell: numbers always as an Array<T>, even a single one; a
/// struct S as S; pods and namedarrays as Array<P> or MultiArray<P>; containers as VarList,
/// VarIntMap, VarStringMap; strings as std::string.
class VarValue {
 public:
  /// Null.
  VarValue() = default;
  /// Holds a value of any type that type_of knows. A scalar number travels as an array of one.
  template <class T>
  requires(!std::is_same_v<std::decay_t<T>, VarValue>) VarValue(T value)
      : VarValue(type_of<T>, value_operations<T>) {  // NOLINT: takes anything
    *static_cast<T*>(place()) = std::move(value);
  }
  /// A string.
  VarValue(const char* text) : VarValue(std::string(text)) {}  // NOLINT
  /// A string.
  VarValue(std::string_view text) : VarValue(std::string(text)) {}  // NOLINT

  /// Whether it is null.
  [[nodiscard]] bool is_null() const { return type_ == nullptr; }
  /// Null for null.
  [[nodiscard]] const Type* type() const { return type_; }
  /// The held value if it is a `T`, else null.
  template <class T>
  [[nodiscard]] const T* get_if() const {
    return type_ == &type_of<T> ? static_cast<const T*>(value()) : nullptr;
  }
  /// Throws rr::Error (data_type_mismatch) when it is no `T`.
  template <class T>
  [[nodiscard]] const T& get() const {
    if (const T* value = get_if<T>()) return *value;
    throw_mismatch();
  }
  /// As one number or value of an enumeration: of a scalar, or of an array of one, which is what a
  /// received scalar is. Throws rr::Error (data_type_mismatch).
  template <class T>
  requires(Number<T> || std::is_enum_v<T>) [[nodiscard]] T number() const {
    if (const T* value = get_if<T>()) return *value;
    if constexpr (std::is_enum_v<T>) {
      return static_cast<T>(number<std::int32_t>());
    } else {
      const Array<T>& array = get<Array<T>>();
      if (array.size() == 1) return array[0];
      throw_mismatch();
    }
  }

  /// Holds a new value of a type known at run time only: place() is where, until the VarValue has
  /// been copied.
  VarValue(const Type& type, const ValueOperations& operations);
  /// Where a value of the type is written, before this is copied; null for null.
  [[nodiscard]] void* place() { return place_; }
  /// The value, of type(); null for null.
  [[nodiscard]] const void* value() const { return place_; }

  /// Whether both have the same type and travel as the same bytes: a NaN is equal to itself.
  friend bool operator==(const VarValue& a, const VarValue& b);

 private:
  [[noreturn]] static void throw_mismatch();

  const Type* type_ = nullptr;
  void* place_ = nullptr;
  MemoryRef memory_;
};

/// How a VarValue travels: as what it holds.
class VarValueType final : public Type {
 public:
  /// Has no state.
  constexpr VarValueType() = default;
  [[nodiscard]] ElementType element_type() const override { return ElementType::void_; }
  void write(Writer& writer, const ElementName& name, const void* value) const override;
  bool read(Decoder& decoder, const Element& element, void* value) const override;
};
/// For the runtime: how a VarValue travels.
inline constexpr VarValueType varvalue_type;
/// `varvalue`.
template <>
inline constexpr const Type& type_of<VarValue> = varvalue_type;

}  // namespace rr
