/* SPDX-License-Identifier: Apache-2.0
 *
 * What the C99 of `robdef generate --lang cbus` stands on: numbers to bytes and back, and the frame
 * that real-time nodes exchange by UDP (docs/howto/realtime.md). No heap, no globals that change,
 * no floating point but what is converted; any thread may call anything.
 *
 * Bytes are little-endian and without gaps on every machine. Where a double has four bytes (AVR),
 * it still has eight on the wire: it is widened exactly, and rounded to the nearest when it comes
 * back.
 */
#ifndef RR_BUS_H
#define RR_BUS_H

#include <float.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Generated code is made for this number. */
#define RR_BUS_API 1

/* Tables of signals cost memory that boards need for other things. */
#if defined(__AVR__) && !defined(RR_BUS_WITH_SIGNALS)
#define RR_BUS_NO_SIGNALS
#endif

/* Fails to compile when the claim does not hold. */
#define RR_BUS_ASSERT(name, claim) typedef char name[(claim) ? 1 : -1]

/* A value that depends on the size of a double here: 8 bytes, or 4. */
#if DBL_MANT_DIG == 53
#define RR_BUS_BY_DOUBLE(eight, four) (eight)
#elif DBL_MANT_DIG == 24
#define RR_BUS_BY_DOUBLE(eight, four) (four)
#else
#error "a double of this machine is neither of the two formats that are known here"
#endif

typedef struct {
  double re;
  double im;
} rr_bus_cdouble;
typedef struct {
  float re;
  float im;
} rr_bus_csingle;

/* Types of signals, numbered as elements on the wire. */
enum {
  RR_BUS_DOUBLE = 1,
  RR_BUS_SINGLE = 2,
  RR_BUS_INT8 = 3,
  RR_BUS_UINT8 = 4,
  RR_BUS_INT16 = 5,
  RR_BUS_UINT16 = 6,
  RR_BUS_INT32 = 7,
  RR_BUS_UINT32 = 8,
  RR_BUS_INT64 = 9,
  RR_BUS_UINT64 = 10,
  RR_BUS_CDOUBLE = 12,
  RR_BUS_CSINGLE = 13,
  RR_BUS_BOOL = 14
};

/* A row of a bus's table: one run of equal numbers. */
typedef struct {
  const char* name; /* `q`, `joints[2].angle` */
  uint8_t type;     /* RR_BUS_... */
  uint32_t count;   /* of items */
  uint32_t offset;  /* in the struct */
  uint32_t place;   /* in the packed bytes */
} rr_bus_signal;

/* Each writes `count` numbers and returns where the next one goes. */
uint8_t* rr_bus_put_double(uint8_t* to, const double* from, uint32_t count);
uint8_t* rr_bus_put_single(uint8_t* to, const float* from, uint32_t count);
uint8_t* rr_bus_put_int8(uint8_t* to, const int8_t* from, uint32_t count);
uint8_t* rr_bus_put_uint8(uint8_t* to, const uint8_t* from, uint32_t count);
uint8_t* rr_bus_put_int16(uint8_t* to, const int16_t* from, uint32_t count);
uint8_t* rr_bus_put_uint16(uint8_t* to, const uint16_t* from, uint32_t count);
uint8_t* rr_bus_put_int32(uint8_t* to, const int32_t* from, uint32_t count);
uint8_t* rr_bus_put_uint32(uint8_t* to, const uint32_t* from, uint32_t count);
uint8_t* rr_bus_put_int64(uint8_t* to, const int64_t* from, uint32_t count);
uint8_t* rr_bus_put_uint64(uint8_t* to, const uint64_t* from, uint32_t count);
uint8_t* rr_bus_put_cdouble(uint8_t* to, const rr_bus_cdouble* from, uint32_t count);
uint8_t* rr_bus_put_csingle(uint8_t* to, const rr_bus_csingle* from, uint32_t count);
/* 0 is false, all else true, and written as 1. */
uint8_t* rr_bus_put_bool(uint8_t* to, const uint8_t* from, uint32_t count);

/* Each reads `count` numbers and returns where the next one stands. */
const uint8_t* rr_bus_get_double(const uint8_t* from, double* to, uint32_t count);
const uint8_t* rr_bus_get_single(const uint8_t* from, float* to, uint32_t count);
const uint8_t* rr_bus_get_int8(const uint8_t* from, int8_t* to, uint32_t count);
const uint8_t* rr_bus_get_uint8(const uint8_t* from, uint8_t* to, uint32_t count);
const uint8_t* rr_bus_get_int16(const uint8_t* from, int16_t* to, uint32_t count);
const uint8_t* rr_bus_get_uint16(const uint8_t* from, uint16_t* to, uint32_t count);
const uint8_t* rr_bus_get_int32(const uint8_t* from, int32_t* to, uint32_t count);
const uint8_t* rr_bus_get_uint32(const uint8_t* from, uint32_t* to, uint32_t count);
const uint8_t* rr_bus_get_int64(const uint8_t* from, int64_t* to, uint32_t count);
const uint8_t* rr_bus_get_uint64(const uint8_t* from, uint64_t* to, uint32_t count);
const uint8_t* rr_bus_get_cdouble(const uint8_t* from, rr_bus_cdouble* to, uint32_t count);
const uint8_t* rr_bus_get_csingle(const uint8_t* from, rr_bus_csingle* to, uint32_t count);
const uint8_t* rr_bus_get_bool(const uint8_t* from, uint8_t* to, uint32_t count);

/* The eight bytes of a double as bits, from the bits of a float; exact. */
uint64_t rr_bus_widen(uint32_t bits);
/* The bits of the float that is nearest, ties to even; too large becomes infinite. */
uint32_t rr_bus_narrow(uint64_t bits);

/* The frame: RR_BUS_HEADER bytes, the packed bus, four bytes of checksum. */
#define RR_BUS_HEADER 40u
#define RR_BUS_OVERHEAD 44u

typedef struct {
  uint64_t schema;   /* the bus's hash */
  uint64_t epoch;    /* when the sender began; larger for a later begin */
  uint64_t sequence; /* from 0 in each epoch */
  int64_t stamp;     /* nanoseconds, by the sender's clock */
} rr_bus_frame;

/* CRC-32 as Ethernet has it. */
uint32_t rr_bus_crc32(const uint8_t* bytes, uint32_t size);
/* Writes header and checksum around `size` packed bytes that stand at frame + RR_BUS_HEADER. */
void rr_bus_seal(const rr_bus_frame* header, uint8_t* frame, uint32_t size);
/* 1 for a sound frame of this size with `size` packed bytes of the bus whose hash is `schema`;
 * these stand at frame + RR_BUS_HEADER then. 0, with `header` untouched, for anything else. */
int rr_bus_open(const uint8_t* frame, uint32_t frame_size, uint64_t schema, uint32_t size,
                rr_bus_frame* header);

/* What has come; begins as zeros. */
typedef struct {
  uint64_t epoch;
  uint64_t sequence;
  uint8_t has_begun;
} rr_bus_order;

/* 1 when the frame is newer than all before, which it is from then on. */
int rr_bus_is_newer(rr_bus_order* order, const rr_bus_frame* header);

#ifdef __cplusplus
}
#endif

#endif
