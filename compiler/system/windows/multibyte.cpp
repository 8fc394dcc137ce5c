// SPDX-License-Identifier: Apache-2.0
// Text of this program is UTF-8, on Windows by its manifest. std::filesystem of mingw does not ask
// for that: it widens names by mbrtowc() of the C library, which without a locale takes each byte
// for a letter, and whose older form, msvcrt, has no locale of UTF-8. This one takes its place in
// the program: every path that is made of text is right then, where a conversion at each place that
// makes one would be forgotten at the next. The C library has the two functions after it in the
// same object file, so a program that uses one of them needs ours of all three.
#include <cerrno>
#include <cstddef>
#include <cwchar>

namespace {

constexpr std::size_t is_wrong = static_cast<std::size_t>(-1);
constexpr std::size_t is_short = static_cast<std::size_t>(-2);

struct Sequence {
  std::size_t size = 0;  ///< bytes; 0: no text begins so
  unsigned value = 0;    ///< bits of the first byte
  unsigned least = 0;    ///< smaller ones have a shorter form
};

Sequence sequence_of(unsigned char first) {
  if (first < 0x80) return {1, first, 0};
  if (first >= 0xC2 && first < 0xE0) return {2, first & 0x1FU, 0x80};
  if (first >= 0xE0 && first < 0xF0) return {3, first & 0x0FU, 0x800};
  if (first >= 0xF0 && first < 0xF5) return {4, first & 0x07U, 0x10000};
  return {};
}

std::size_t fail() {
  errno = EILSEQ;
  return is_wrong;
}

}  // namespace

// A letter beyond 16 bits is two: the first is given for three of its bytes, the second for the
// last one.
extern "C" std::size_t mbrtowc(wchar_t* wide, const char* text, std::size_t size,
                               std::mbstate_t* state) {
  static std::mbstate_t own_state{};
  if (state == nullptr) state = &own_state;
  if (text == nullptr) {
    *state = 0;
    return 0;
  }
  if (size == 0) return is_short;
  wchar_t unused = 0;
  if (wide == nullptr) wide = &unused;
  if (*state != 0) {
    *wide = static_cast<wchar_t>(*state);
    *state = 0;
    return 1;
  }
  Sequence sequence = sequence_of(static_cast<unsigned char>(*text));
  if (sequence.size == 0) return fail();
  unsigned value = sequence.value;
  for (std::size_t at = 1; at < sequence.size; ++at) {
    if (at == size) return is_short;
    const auto byte = static_cast<unsigned char>(text[at]);
    if ((byte & 0xC0U) != 0x80) return fail();
    value = (value << 6U) | (byte & 0x3FU);
  }
  const bool is_surrogate = value >= 0xD800 && value < 0xE000;
  if (value < sequence.least || value > 0x10FFFF || is_surrogate) return fail();
  if (value < 0x10000) {
    *wide = static_cast<wchar_t>(value);
    return value == 0 ? 0 : sequence.size;
  }
  value -= 0x10000;
  *wide = static_cast<wchar_t>(0xD800U + (value >> 10U));
  *state = static_cast<std::mbstate_t>(0xDC00U + (value & 0x3FFU));
  return 3;
}

extern "C" std::size_t mbrlen(const char* text, std::size_t size, std::mbstate_t* state) {
  static std::mbstate_t own_state{};
  return mbrtowc(nullptr, text, size, state == nullptr ? &own_state : state);
}

extern "C" std::size_t mbsrtowcs(wchar_t* wide, const char** text, std::size_t size,
                                 std::mbstate_t* state) {
  static std::mbstate_t own_state{};
  if (state == nullptr) state = &own_state;
  const char* at = *text;
  std::size_t count = 0;
  for (; wide == nullptr || count < size; ++count) {
    wchar_t one = 0;
    const std::size_t taken = mbrtowc(&one, at, 4, state);
    if (taken == is_wrong || taken == is_short) return fail();
    if (wide != nullptr) wide[count] = one;
    if (one == 0) {
      if (wide != nullptr) *text = nullptr;
      return count;
    }
    at += taken;
  }
  *text = at;
  return count;
}
