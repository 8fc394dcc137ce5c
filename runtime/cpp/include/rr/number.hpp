// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <complex>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include "rr/complex.hpp"
#include "rr/visibility.hpp"
#include "rr/wire.hpp"

/// Numbers whose type is known at run time.
namespace RR_VISIBLE rr {

/// Numbers, complex ones and bool.
constexpr bool is_number(ElementType type) {
  return item_size(type) != 0 && type != ElementType::string;
}

/// Calls `use` with std::type_identity of the C++ type of a number, and returns what it does.
/// `type` is a number, bool or complex number; another is taken for a double.
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

/// `double`, `uint8`, as definitions spell it; what has no word there as the specification calls it
/// (01, section 5). Empty for a number that is no type.
std::string_view word_of(ElementType type);

}  // namespace rr
