// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/dynamic/numbers.hpp"

#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace rr::dynamic {
namespace {

// The largest integers of 64 bits, and one more, as doubles.
constexpr double signed_end = 9223372036854775808.0;
constexpr double unsigned_end = 18446744073709551616.0;

template <class T>
constexpr bool is_complex_type = false;
template <class T>
constexpr bool is_complex_type<std::complex<T>> = true;

template <class To>
bool real_to(double from, To& to) {
  if constexpr (std::is_integral_v<To>) {
    if (!(from >= -signed_end && from < unsigned_end) || std::trunc(from) != from) return false;
    if (from < 0) {
      const auto whole = static_cast<std::int64_t>(from);
      if (!std::in_range<To>(whole)) return false;
      to = static_cast<To>(whole);
    } else {
      const auto whole = static_cast<std::uint64_t>(from);
      if (!std::in_range<To>(whole)) return false;
      to = static_cast<To>(whole);
    }
  } else {
    if (std::isfinite(from) && std::abs(from) > std::numeric_limits<To>::max()) return false;
    to = static_cast<To>(from);
  }
  return true;
}

template <class From, class To>
bool integer_to(From from, To& to) {
  if constexpr (std::is_integral_v<To>) {
    if (!std::in_range<To>(from)) return false;
    to = static_cast<To>(from);
  } else {
    const auto rounded = static_cast<To>(from);
    From back = 0;
    if (!real_to(static_cast<double>(rounded), back) || back != from) return false;
    to = rounded;
  }
  return true;
}

template <class From, class To>
bool convert(const From& from, To& to) {
  if constexpr (std::is_same_v<From, To>) {
    to = from;
    return true;
  } else if constexpr (std::is_same_v<From, bool> || std::is_same_v<To, bool>) {
    return false;
  } else if constexpr (is_complex_type<To>) {
    typename To::value_type real{};
    typename To::value_type imaginary{};
    if constexpr (is_complex_type<From>) {
      if (!convert(from.imag(), imaginary) || !convert(from.real(), real)) return false;
    } else {
      if (!convert(from, real)) return false;
    }
    to = To(real, imaginary);
    return true;
  } else if constexpr (is_complex_type<From>) {
    return from.imag() == 0 && convert(from.real(), to);
  } else if constexpr (std::is_integral_v<From>) {
    return integer_to(from, to);
  } else {
    return real_to(static_cast<double>(from), to);
  }
}

template <class T>
std::string text_of(T number) {
  if constexpr (std::is_floating_point_v<T>) {
    if (std::isnan(number)) return "NaN";
    if (std::isinf(number)) return number > 0 ? "Infinity" : "-Infinity";
  }
  char text[40];
  const auto end = std::to_chars(text, text + sizeof text, number);
  return {text, end.ptr};
}

}  // namespace

bool is_complex(ElementType type) {
  return type == ElementType::cdouble || type == ElementType::csingle;
}

std::size_t alignment_of(ElementType type) {
  return with_number(type, [](auto of) { return alignof(typename decltype(of)::type); });
}

const ItemType& number_item(ElementType type) {
  return with_number(
      type, [](auto of) -> const ItemType& { return item_type<typename decltype(of)::type>; });
}

const rr::Type& number_wire_type(ElementType type) {
  return with_number(
      type, [](auto of) -> const rr::Type& { return type_of<typename decltype(of)::type>; });
}

bool convert_number(ElementType from_type, const void* from, ElementType to_type, void* to) {
  return with_number(from_type, [&](auto of) {
    typename decltype(of)::type given;
    std::memcpy(&given, from, sizeof given);
    return with_number(to_type, [&](auto wanted) {
      typename decltype(wanted)::type result{};
      if (!convert(given, result)) return false;
      std::memcpy(to, &result, sizeof result);
      return true;
    });
  });
}

std::string number_text(ElementType type, const void* number) {
  return with_number(type, [&](auto of) -> std::string {
    using T = typename decltype(of)::type;
    T value;
    std::memcpy(&value, number, sizeof value);
    if constexpr (std::is_same_v<T, bool>) {
      return value ? "true" : "false";
    } else if constexpr (is_complex_type<T>) {
      return "[" + text_of(value.real()) + ", " + text_of(value.imag()) + "]";
    } else {
      return text_of(value);
    }
  });
}

}  // namespace rr::dynamic
