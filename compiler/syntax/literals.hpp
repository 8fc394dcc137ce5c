// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace robdef::syntax {

/// A whole number as written, decimal or hexadecimal.
struct Integer {
  bool is_negative = false;
  bool is_hexadecimal = false;
  bool is_too_large = false;  ///< beyond 64 bits
  std::uint64_t magnitude = 0;
};

/// Wants text of the grammar's `int` or `hex`.
Integer read_integer(std::string_view text);

/// Whether the number lies in a signed or unsigned type of that many bits. Unsigned types take a
/// minus sign, and wrap (Q13).
bool fits(const Integer& integer, bool is_signed, int bits);

enum class FloatFit { fits, overflows, underflows };

/// Whether text of the grammar's `int` or `float` can be held as a double (or as a single).
FloatFit fit_float(std::string_view text, bool is_single);

/// What is wrong with the text of a string, quotes included, as offsets into it.
struct StringFault {
  bool is_unclosed = false;
  std::size_t begin = 0;  ///< of a wrong escape
  std::size_t end = 0;
};

/// Wants text that begins with a quote and is not a string of the grammar.
StringFault find_string_fault(std::string_view text);

/// The value of a string literal, quotes included, as UTF-8. Nothing if an escape is half of a
/// surrogate pair; then `fault` says where.
std::optional<std::string> read_string(std::string_view text, StringFault& fault);

}  // namespace robdef::syntax
