// SPDX-License-Identifier: Apache-2.0
#include "values.h"

namespace rr {
namespace {

#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
uint8_t place(uint8_t index, uint8_t size) { return static_cast<uint8_t>(size - 1 - index); }
#else
uint8_t place(uint8_t index, uint8_t) { return index; }
#endif

// A double of the machine and the bits of an IEEE number of eight bytes. Overloads on the size, so
// that the one that is not needed is not there.
template <size_t Size>
struct Bits;
template <>
struct Bits<4> {
  static uint64_t of(const void* value) {
    uint32_t single = 0;
    memcpy(&single, value, 4);
    return widen(single);
  }
  static void into(void* value, uint64_t wide) {
    const uint32_t single = narrow(wide);
    memcpy(value, &single, 4);
  }
};
template <>
struct Bits<8> {
  static uint64_t of(const void* value) {
    uint64_t wide = 0;
    memcpy(&wide, value, 8);
    return wide;
  }
  static void into(void* value, uint64_t wide) { memcpy(value, &wide, 8); }
};

}  // namespace

bool Reader::take(void* number, uint8_t size) {
  if (!isGood_ || left_ < size) {
    isGood_ = false;
    return false;
  }
  uint8_t* const bytes = static_cast<uint8_t*>(number);
  for (uint8_t index = 0; index < size; ++index) bytes[place(index, size)] = *at_++;
  left_ = static_cast<uint8_t>(left_ - size);
  return true;
}

bool Reader::takeCount(uint8_t& count, uint8_t limit) {
  if (take(&count, 1) && count <= limit) return true;
  count = 0;
  isGood_ = false;
  return false;
}

bool Writer::put(const void* number, uint8_t size) {
  if (!isGood_ || room() < size) {
    isGood_ = false;
    return false;
  }
  const uint8_t* const bytes = static_cast<const uint8_t*>(number);
  for (uint8_t index = 0; index < size; ++index) start_[count_++] = bytes[place(index, size)];
  return true;
}

void Writer::clear() {
  count_ = 0;
  isGood_ = true;
}

bool read(Reader& reader, bool& value) {
  uint8_t byte = 0;
  if (!reader.takeCount(byte, 1)) return false;
  value = byte != 0;
  return true;
}

bool read(Reader& reader, double& value) {
  uint64_t wide = 0;
  if (!reader.take(&wide, 8)) return false;
  Bits<sizeof(double)>::into(&value, wide);
  return true;
}

bool write(Writer& writer, double value) {
  const uint64_t wide = Bits<sizeof(double)>::of(&value);
  return writer.put(&wide, 8);
}

// The halves are worked on apart: shifts of 64 bits cost an AVR a loop each.
uint64_t widen(uint32_t single) {
  const uint32_t sign = single & 0x80000000UL;
  uint32_t exponent = (single >> 23) & 0xFF;
  uint32_t fraction = single & 0x7FFFFFUL;
  if (exponent == 0 && fraction != 0) {  // subnormal: there are enough exponents here
    exponent = 1;
    while ((fraction & 0x800000UL) == 0) {
      fraction <<= 1;
      --exponent;
    }
    fraction &= 0x7FFFFFUL;
    exponent += 1023 - 127;
  } else if (exponent == 0xFF) {
    exponent = 0x7FF;
  } else if (exponent != 0) {
    exponent += 1023 - 127;
  }
  const uint32_t high = sign | ((exponent & 0x7FF) << 20) | (fraction >> 3);
  return (static_cast<uint64_t>(high) << 32) | (fraction << 29);
}

uint32_t narrow(uint64_t wide) {
  const uint32_t high = static_cast<uint32_t>(wide >> 32);
  const uint32_t low = static_cast<uint32_t>(wide);
  const uint32_t sign = high & 0x80000000UL;
  const uint16_t exponent = static_cast<uint16_t>((high >> 20) & 0x7FF);
  // 24 bits with the leading one, and whether anything was behind them.
  uint32_t fraction = ((high & 0xFFFFFUL) << 3) | (low >> 29);
  uint32_t rest = low << 3;
  if (exponent == 0x7FF) {
    const bool isNumber = fraction == 0 && rest == 0;
    return sign | 0x7F800000UL | (isNumber ? 0 : fraction | 0x400000UL);
  }
  const int16_t target = static_cast<int16_t>(static_cast<int16_t>(exponent) - (1023 - 127));
  if (target >= 0xFF) return sign | 0x7F800000UL;
  if (target < -23) return sign;
  uint32_t result = sign;
  if (target <= 0) {  // becomes subnormal
    fraction |= 0x800000UL;
    for (int16_t shift = target; shift <= 0; ++shift) {
      rest = (rest >> 1) | (fraction << 31) | (rest & 1);
      fraction >>= 1;
    }
  } else {
    result |= static_cast<uint32_t>(target) << 23;
  }
  result += fraction;
  // A carry out of the fraction goes into the exponent, as it should.
  const bool isUp = rest > 0x80000000UL || (rest == 0x80000000UL && (fraction & 1) != 0);
  return isUp ? result + 1 : result;
}

}  // namespace rr
