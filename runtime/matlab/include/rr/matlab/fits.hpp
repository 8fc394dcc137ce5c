// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <complex>
#include <concepts>
#include <cstdint>
#include <limits>
#include <string_view>
#include <type_traits>
#include <utility>

/// Which numbers of the interpreter a type of the protocol takes.
namespace rr::matlab {

template <class T>
inline constexpr bool is_complex_number = false;
template <class T>
inline constexpr bool is_complex_number<std::complex<T>> = true;

/// As definitions spell it.
template <class T>
constexpr std::string_view word_of_number() {
  if constexpr (std::is_same_v<T, double>) return "double";
  if constexpr (std::is_same_v<T, float>) return "single";
  if constexpr (std::is_same_v<T, bool>) return "bool";
  if constexpr (std::is_same_v<T, std::complex<double>>) return "cdouble";
  if constexpr (std::is_same_v<T, std::complex<float>>) return "csingle";
  if constexpr (std::is_same_v<T, std::int8_t>) return "int8";
  if constexpr (std::is_same_v<T, std::uint8_t>) return "uint8";
  if constexpr (std::is_same_v<T, std::int16_t>) return "int16";
  if constexpr (std::is_same_v<T, std::uint16_t>) return "uint16";
  if constexpr (std::is_same_v<T, std::int32_t>) return "int32";
  if constexpr (std::is_same_v<T, std::uint32_t>) return "uint32";
  if constexpr (std::is_same_v<T, std::int64_t>) return "int64";
  if constexpr (std::is_same_v<T, std::uint64_t>) return "uint64";
  return "";
}

/// Whether a To holds the number, and it is assigned then. Integers must be exact and in range; a
/// double must hold an integer exactly; a single may round, but not become infinite; a bool takes 0
/// and 1.
template <class To, class From>
bool take_number(From from, To& to) {
  if constexpr (std::is_same_v<To, From>) {
    to = from;
    return true;
  } else if constexpr (std::is_same_v<From, bool>) {
    to = static_cast<To>(from ? 1 : 0);
    return true;
  } else if constexpr (std::is_same_v<To, bool>) {
    to = from == From{1};
    return from == From{0} || from == From{1};
  } else if constexpr (std::integral<To> && std::integral<From>) {
    to = static_cast<To>(from);
    return std::in_range<To>(from);
  } else if constexpr (std::integral<To>) {
    // Both bounds are powers of two, or zero, and so exact in floating point.
    constexpr From low = static_cast<From>(std::numeric_limits<To>::min());
    const From beyond = std::ldexp(From{1}, std::numeric_limits<To>::digits);
    if (!(from >= low && from < beyond) || from != std::trunc(from)) return false;
    to = static_cast<To>(from);
    return true;
  } else if constexpr (std::is_same_v<To, double> && std::integral<From>) {
    to = static_cast<double>(from);
    From again{};
    return take_number(to, again) && again == from;
  } else {
    to = static_cast<To>(from);
    return std::isfinite(static_cast<double>(to)) || !std::isfinite(static_cast<double>(from));
  }
}

}  // namespace rr::matlab
