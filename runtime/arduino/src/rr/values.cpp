// SPDX-License-Identifier: Apache-2.0
#include "values.h"

namespace rr {
namespace {

void copy(void* to, const void* from, uint8_t size) {
  uint8_t* const target = static_cast<uint8_t*>(to);
  const uint8_t* const source = static_cast<const uint8_t*>(from);
  for (uint8_t index = 0; index < size; ++index) {
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
    target[size - 1 - index] = source[index];
#else
    target[index] = source[index];
#endif
  }
}

// How a double of the machine travels. Chosen by its size, so that the other one is not there.
template <size_t Size>
struct Travel;
template <>
struct Travel<4> {
  static void write(const void* value, uint8_t* wide) {
    uint32_t single;
    memcpy(&single, value, 4);
    widen(single, wide);
  }
  static void read(const uint8_t* wide, void* value) {
    const uint32_t single = narrow(wide);
    memcpy(value, &single, 4);
  }
};
template <>
struct Travel<8> {
  static void write(const void* value, uint8_t* wide) { copy(wide, value, 8); }
  static void read(const uint8_t* wide, void* value) { copy(value, wide, 8); }
};

}  // namespace

const uint8_t* Reader::skip(uint8_t size) {
  if (!isGood_ || left_ < size) {
    isGood_ = false;
    return nullptr;
  }
  const uint8_t* const bytes = at_;
  at_ += size;
  left_ = static_cast<uint8_t>(left_ - size);
  return bytes;
}

bool Reader::take(void* number, uint8_t size) {
  const uint8_t* const bytes = skip(size);
  if (bytes == nullptr) return false;
  copy(number, bytes, size);
  return true;
}

bool Reader::takeCount(uint8_t& count, uint8_t limit) {
  if (take(&count, 1)) {
    if (count <= limit) return true;
    refusal_ = Status::BufferLimitViolation;
  }
  count = 0;
  isGood_ = false;
  return false;
}

uint8_t* Writer::skip(uint8_t size) {
  if (!isGood_ || room() < size) {
    isGood_ = false;
    return nullptr;
  }
  uint8_t* const bytes = start_ + count_;
  count_ = static_cast<uint8_t>(count_ + size);
  return bytes;
}

bool Writer::put(const void* number, uint8_t size) {
  uint8_t* const bytes = skip(size);
  if (bytes == nullptr) return false;
  copy(bytes, number, size);
  return true;
}

bool read(Reader& reader, bool& value) {
  uint8_t byte = 0;
  if (!reader.take(&byte, 1) || byte > 1) return false;
  value = byte != 0;
  return true;
}

bool read(Reader& reader, double& value) {
  const uint8_t* const wide = reader.skip(8);
  if (wide == nullptr) return false;
  Travel<sizeof(double)>::read(wide, &value);
  return true;
}

bool write(Writer& writer, const double& value) {
  uint8_t* const wide = writer.skip(8);
  if (wide == nullptr) return false;
  Travel<sizeof(double)>::write(&value, wide);
  return true;
}

// Of the fraction's 52 bits a float has the first 23. They are in the upper four of the seven bytes
// of the fraction, with five bits behind them that only rounding needs.
void widen(uint32_t single, uint8_t* wide) {
  const uint8_t sign = static_cast<uint8_t>(single >> 24) & 0x80U;
  int16_t exponent = static_cast<uint8_t>(single >> 23);
  uint32_t fraction = single & 0x7FFFFFU;
  if (exponent == 0xFF) {
    exponent = 0x7FF;
  } else if (exponent != 0 || fraction != 0) {
    if (exponent == 0) {  // subnormal: there are enough exponents here
      ++exponent;
      while ((fraction & 0x800000U) == 0) {
        fraction <<= 1;
        --exponent;
      }
      fraction &= 0x7FFFFFU;
    }
    exponent = static_cast<int16_t>(exponent + 1023 - 127);
  }
  fraction <<= 5;
  exponent = static_cast<int16_t>(exponent << 4);
  wide[0] = wide[1] = wide[2] = 0;
  wide[3] = static_cast<uint8_t>(fraction);
  wide[4] = static_cast<uint8_t>(fraction >> 8);
  wide[5] = static_cast<uint8_t>(fraction >> 16);
  wide[6] = static_cast<uint8_t>(static_cast<uint8_t>(fraction >> 24) | exponent);
  wide[7] = static_cast<uint8_t>(sign | (exponent >> 8));
}

uint32_t narrow(const uint8_t* wide) {
  const uint32_t sign = static_cast<uint32_t>(wide[7] & 0x80U) << 24;
  const int16_t exponent = static_cast<int16_t>(((wide[7] & 0x7FU) << 8 | wide[6]) >> 4);
  uint32_t fraction = static_cast<uint32_t>(wide[6] & 0xFU) << 24 |
                      static_cast<uint32_t>(wide[5]) << 16 |
                      static_cast<uint16_t>(static_cast<uint16_t>(wide[4]) << 8 | wide[3]);
  // What is behind those bits counts where they are half way between two floats, and in a NaN.
  if ((wide[0] | wide[1] | wide[2]) != 0) fraction |= 1;
  if (exponent == 0x7FF) {
    return sign | 0x7F800000U | (fraction == 0 ? 0 : fraction >> 5 | 0x400000U);
  }
  int16_t target = static_cast<int16_t>(exponent - (1023 - 127));
  if (target >= 0xFF) return sign | 0x7F800000U;
  if (target < -23) return sign;
  if (target <= 0) {  // becomes subnormal
    fraction |= 0x10000000U;
    for (; target <= 0; ++target) fraction = fraction >> 1 | (fraction & 1);
    target = 0;
  }
  // The five bits and the one in front of them: up from half on, but at half only from an odd one.
  const uint8_t rest = static_cast<uint8_t>(fraction) & 0x3FU;
  const bool isUp = (rest & 0x1FU) > 0x10 || rest == 0x30;
  // A carry out of the fraction goes into the exponent, as it should.
  return sign | ((static_cast<uint32_t>(target) << 23) + (fraction >> 5) + (isUp ? 1 : 0));
}

}  // namespace rr
