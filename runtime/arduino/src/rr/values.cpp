// SPDX-License-Identifier: Apache-2.0
#include "values.h"

namespace rr {
namespace {

#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
uint8_t place(uint8_t index, uint8_t size) { return static_cast<uint8_t>(size - 1 - index); }
#else
uint8_t place(uint8_t index, uint8_t) { return index; }
#endif

// How a double of the machine travels. Chosen by its size, so that the other one is not there.
template <size_t Size>
struct Travel;
template <>
struct Travel<4> {
  static bool write(Writer& writer, const void* value) {
    uint32_t single = 0;
    memcpy(&single, value, 4);
    const WideBits wide = widen(single);
    return writer.put(&wide.low, 4) && writer.put(&wide.high, 4);
  }
  static bool read(Reader& reader, void* value) {
    WideBits wide = {0, 0};
    if (!reader.take(&wide.low, 4) || !reader.take(&wide.high, 4)) return false;
    const uint32_t single = narrow(wide);
    memcpy(value, &single, 4);
    return true;
  }
};
template <>
struct Travel<8> {
  static bool write(Writer& writer, const void* value) { return writer.put(value, 8); }
  static bool read(Reader& reader, void* value) { return reader.take(value, 8); }
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

bool read(Reader& reader, double& value) { return Travel<sizeof(double)>::read(reader, &value); }

bool write(Writer& writer, const double& value) {
  return Travel<sizeof(double)>::write(writer, &value);
}

// Shifts are written so that as few bytes as possible are moved bit by bit.
WideBits widen(uint32_t single) {
  const uint16_t sign = static_cast<uint16_t>(single >> 16) & 0x8000U;
  uint16_t exponent = (static_cast<uint16_t>(single >> 16) >> 7) & 0xFF;
  uint32_t fraction = single & 0x7FFFFFU;
  if (exponent == 0xFF) {
    exponent = 0x7FF;
  } else if (exponent != 0 || fraction != 0) {
    if (exponent == 0) {  // subnormal: there are enough exponents here
      exponent = 1;
      while ((fraction & 0x800000U) == 0) {
        fraction <<= 1;
        --exponent;
      }
      fraction &= 0x7FFFFFU;
    }
    exponent = static_cast<uint16_t>(exponent + 1023 - 127);
  }
  const uint16_t top = static_cast<uint16_t>(sign | static_cast<uint16_t>(exponent << 4));
  const uint8_t bottom = static_cast<uint8_t>(static_cast<uint8_t>(fraction) << 5);
  const WideBits wide = {static_cast<uint32_t>(bottom) << 24,
                         (static_cast<uint32_t>(top) << 16) + (fraction >> 3)};
  return wide;
}

uint32_t narrow(WideBits wide) {
  const uint32_t sign = wide.high & 0x80000000U;
  const int16_t exponent =
      static_cast<int16_t>((static_cast<uint16_t>(wide.high >> 16) >> 4) & 0x7FF);
  // 23 bits, and whether anything was behind them.
  uint32_t fraction = ((wide.high & 0xFFFFFU) << 3) | (static_cast<uint8_t>(wide.low >> 24) >> 5);
  uint32_t rest = wide.low << 3;
  if (exponent == 0x7FF) {
    const bool isNumber = fraction == 0 && rest == 0;
    return sign | 0x7F800000U | (isNumber ? 0 : fraction | 0x400000U);
  }
  int16_t target = static_cast<int16_t>(exponent - (1023 - 127));
  if (target >= 0xFF) return sign | 0x7F800000U;
  if (target < -23) return sign;
  if (target <= 0) {  // becomes subnormal
    fraction |= 0x800000U;
    for (; target <= 0; ++target) {
      rest = (rest >> 1) | (fraction << 31) | (rest & 1);
      fraction >>= 1;
    }
    target = 0;
  }
  // A carry out of the fraction goes into the exponent, as it should.
  const uint32_t result = (static_cast<uint32_t>(target) << 23) + fraction;
  const bool isUp = rest > 0x80000000U || (rest == 0x80000000U && (fraction & 1) != 0);
  return sign | (isUp ? result + 1 : result);
}

}  // namespace rr
