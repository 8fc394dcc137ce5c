// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <complex>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

#include "rr/complex.hpp"
#include "rr/type.hpp"

/// Numbers whose type is known at run time.
namespace rr::dynamic {

/// Calls `use` with std::type_identity of the C++ type of a number, and returns what it does.
/// `type` is a number, bool or complex number.
template <class Use>
decltype(auto) with_number(ElementType type, Use&& use) {
  switch (type) {
    case ElementType::single:
      return use(std::type_identity<float>());
    case ElementType::int8:
      return use(std::type_identity<std::int8_t>());
    case ElementType::uint8:
      return use(std::type_identity<std::uint8_t>());
    case ElementType::int16:
      return use(std::type_identity<std::int16_t>());
    case ElementType::uint16:
      return use(std::type_identity<std::uint16_t>());
    case ElementType::int32:
      return use(std::type_identity<std::int32_t>());
    case ElementType::uint32:
      return use(std::type_identity<std::uint32_t>());
    case ElementType::int64:
      return use(std::type_identity<std::int64_t>());
    case ElementType::uint64:
      return use(std::type_identity<std::uint64_t>());
    case ElementType::cdouble:
      return use(std::type_identity<std::complex<double>>());
    case ElementType::csingle:
      return use(std::type_identity<std::complex<float>>());
    case ElementType::bool_:
      return use(std::type_identity<bool>());
    default:
      return use(std::type_identity<double>());
  }
}

/// `double`, `uint8`, as definitions spell it; `string` and `void` too.
std::string_view word_of(ElementType type);
bool is_complex(ElementType type);
/// Alignment of a number in memory.
std::size_t alignment_of(ElementType type);
/// Describes items of this type; lives for ever.
const ItemType& number_item(ElementType type);
const rr::Type& number_wire_type(ElementType type);

/// Writes the number at `from` as a `to_type` into `to`, if that holds it exactly; a float may
/// round. False, with `to` untouched, otherwise.
bool convert_number(ElementType from_type, const void* from, ElementType to_type, void* to);
/// Shortest decimal; `NaN`, `Infinity`, `-Infinity`; `true`, `false`; `[re, im]`.
std::string number_text(ElementType type, const void* number);

}  // namespace rr::dynamic
