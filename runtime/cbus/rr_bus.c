/* SPDX-License-Identifier: Apache-2.0 */
#include "rr_bus.h"

#include <string.h>

static uint8_t* put_bits(uint8_t* to, uint64_t bits, uint8_t size) {
  uint8_t i;
  for (i = 0; i < size; ++i) {
    *to++ = (uint8_t)bits;
    bits >>= 8;
  }
  return to;
}

static uint64_t get_bits(const uint8_t* from, uint8_t size) {
  uint64_t bits = 0;
  while (size > 0) bits = (bits << 8) | from[--size];
  return bits;
}

/* Numbers of one type: their bits are in an unsigned type of the same size. */
#define RR_BUS_NUMBERS(name, type, unsigned_type)                                    \
  uint8_t* rr_bus_put_##name(uint8_t* to, const type* from, uint32_t count) {        \
    while (count-- > 0) {                                                            \
      unsigned_type bits;                                                            \
      memcpy(&bits, from++, sizeof bits);                                            \
      to = put_bits(to, bits, sizeof bits);                                          \
    }                                                                                \
    return to;                                                                       \
  }                                                                                  \
  const uint8_t* rr_bus_get_##name(const uint8_t* from, type* to, uint32_t count) {  \
    while (count-- > 0) {                                                            \
      const unsigned_type bits = (unsigned_type)get_bits(from, sizeof(unsigned_type)); \
      memcpy(to++, &bits, sizeof bits);                                              \
      from += sizeof bits;                                                           \
    }                                                                                \
    return from;                                                                     \
  }

RR_BUS_ASSERT(rr_bus_float_has_four_bytes, sizeof(float) == 4);
RR_BUS_NUMBERS(single, float, uint32_t)
RR_BUS_NUMBERS(int8, int8_t, uint8_t)
RR_BUS_NUMBERS(uint8, uint8_t, uint8_t)
RR_BUS_NUMBERS(int16, int16_t, uint16_t)
RR_BUS_NUMBERS(uint16, uint16_t, uint16_t)
RR_BUS_NUMBERS(int32, int32_t, uint32_t)
RR_BUS_NUMBERS(uint32, uint32_t, uint32_t)
RR_BUS_NUMBERS(int64, int64_t, uint64_t)
RR_BUS_NUMBERS(uint64, uint64_t, uint64_t)

#if DBL_MANT_DIG == 53
RR_BUS_NUMBERS(double, double, uint64_t)
#else
uint8_t* rr_bus_put_double(uint8_t* to, const double* from, uint32_t count) {
  while (count-- > 0) {
    uint32_t bits;
    memcpy(&bits, from++, sizeof bits);
    to = put_bits(to, rr_bus_widen(bits), 8);
  }
  return to;
}

const uint8_t* rr_bus_get_double(const uint8_t* from, double* to, uint32_t count) {
  while (count-- > 0) {
    const uint32_t bits = rr_bus_narrow(get_bits(from, 8));
    memcpy(to++, &bits, sizeof bits);
    from += 8;
  }
  return from;
}
#endif

uint8_t* rr_bus_put_cdouble(uint8_t* to, const rr_bus_cdouble* from, uint32_t count) {
  for (; count > 0; --count, ++from) {
    to = rr_bus_put_double(rr_bus_put_double(to, &from->re, 1), &from->im, 1);
  }
  return to;
}

const uint8_t* rr_bus_get_cdouble(const uint8_t* from, rr_bus_cdouble* to, uint32_t count) {
  for (; count > 0; --count, ++to) {
    from = rr_bus_get_double(rr_bus_get_double(from, &to->re, 1), &to->im, 1);
  }
  return from;
}

uint8_t* rr_bus_put_csingle(uint8_t* to, const rr_bus_csingle* from, uint32_t count) {
  for (; count > 0; --count, ++from) {
    to = rr_bus_put_single(rr_bus_put_single(to, &from->re, 1), &from->im, 1);
  }
  return to;
}

const uint8_t* rr_bus_get_csingle(const uint8_t* from, rr_bus_csingle* to, uint32_t count) {
  for (; count > 0; --count, ++to) {
    from = rr_bus_get_single(rr_bus_get_single(from, &to->re, 1), &to->im, 1);
  }
  return from;
}

uint8_t* rr_bus_put_bool(uint8_t* to, const uint8_t* from, uint32_t count) {
  while (count-- > 0) *to++ = *from++ != 0;
  return to;
}

const uint8_t* rr_bus_get_bool(const uint8_t* from, uint8_t* to, uint32_t count) {
  while (count-- > 0) *to++ = *from++ != 0;
  return from;
}

uint64_t rr_bus_widen(uint32_t bits) {
  const uint64_t sign = (uint64_t)(bits >> 31) << 63;
  int16_t exponent = (int16_t)((bits >> 23) & 0xFF);
  uint32_t fraction = bits & 0x7FFFFFUL;
  if (exponent == 0xFF) return sign | (uint64_t)0x7FF << 52 | (uint64_t)fraction << 29;
  if (exponent == 0) {
    if (fraction == 0) return sign;
    /* Below the normal floats, but a normal double. */
    exponent = 1;
    while ((fraction & 0x800000UL) == 0) {
      fraction <<= 1;
      --exponent;
    }
    fraction &= 0x7FFFFFUL;
  }
  return sign | (uint64_t)(exponent + (1023 - 127)) << 52 | (uint64_t)fraction << 29;
}

uint32_t rr_bus_narrow(uint64_t bits) {
  const uint32_t sign = (uint32_t)(bits >> 63) << 31;
  const int16_t exponent = (int16_t)((bits >> 52) & 0x7FF);
  uint64_t fraction = bits & (((uint64_t)1 << 52) - 1);
  int16_t shift = 29;
  uint32_t result;
  uint64_t rest;
  if (exponent == 0x7FF) {
    if (fraction == 0) return sign | 0x7F800000UL;
    return sign | 0x7FC00000UL | (uint32_t)(fraction >> 29); /* stays no number */
  }
  if (exponent > 1023 + 127) return sign | 0x7F800000UL;
  if (exponent > 1023 - 127) {
    result = (uint32_t)(exponent - (1023 - 127)) << 23 | (uint32_t)(fraction >> 29);
  } else {
    /* Below the normal floats: the leading one is written, at its place. */
    shift = (int16_t)(shift + (1023 - 126) - exponent);
    if (shift > 53) return sign;
    fraction |= (uint64_t)1 << 52;
    result = (uint32_t)(fraction >> shift);
  }
  rest = fraction & (((uint64_t)1 << shift) - 1);
  if (rest > (uint64_t)1 << (shift - 1) || (rest == (uint64_t)1 << (shift - 1) && (result & 1) != 0)) {
    ++result; /* may become the next power of two, or infinite: the bits follow each other so */
  }
  return sign | result;
}

uint32_t rr_bus_crc32(const uint8_t* bytes, uint32_t size) {
  uint32_t value = 0xFFFFFFFFUL;
  while (size-- > 0) {
    uint8_t bit;
    value ^= *bytes++;
    for (bit = 0; bit < 8; ++bit) value = (value >> 1) ^ ((0 - (value & 1)) & 0xEDB88320UL);
  }
  return ~value;
}

void rr_bus_seal(const rr_bus_frame* header, uint8_t* frame, uint32_t size) {
  uint8_t* to = frame;
  memcpy(to, "RRSF", 4);
  to = put_bits(to + 4, 1, 2);
  to = put_bits(to, size, 2);
  to = put_bits(to, header->schema, 8);
  to = put_bits(to, header->epoch, 8);
  to = put_bits(to, header->sequence, 8);
  put_bits(to, (uint64_t)header->stamp, 8);
  put_bits(frame + RR_BUS_HEADER + size, rr_bus_crc32(frame, RR_BUS_HEADER + size), 4);
}

int rr_bus_open(const uint8_t* frame, uint32_t frame_size, uint64_t schema, uint32_t size,
                rr_bus_frame* header) {
  if (frame_size != size + RR_BUS_OVERHEAD || memcmp(frame, "RRSF", 4) != 0) return 0;
  if (get_bits(frame + 4, 2) != 1 || get_bits(frame + 6, 2) != size) return 0;
  if (get_bits(frame + 8, 8) != schema) return 0;
  if (get_bits(frame + RR_BUS_HEADER + size, 4) != rr_bus_crc32(frame, RR_BUS_HEADER + size)) return 0;
  header->schema = schema;
  header->epoch = get_bits(frame + 16, 8);
  header->sequence = get_bits(frame + 24, 8);
  header->stamp = (int64_t)get_bits(frame + 32, 8);
  return 1;
}

int rr_bus_is_newer(rr_bus_order* order, const rr_bus_frame* header) {
  const int is_newer =
      !order->has_begun || header->epoch > order->epoch ||
      (header->epoch == order->epoch && header->sequence > order->sequence);
  if (!is_newer) return 0;
  order->has_begun = 1;
  order->epoch = header->epoch;
  order->sequence = header->sequence;
  return 1;
}
