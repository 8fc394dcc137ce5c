/* SPDX-License-Identifier: Apache-2.0 */
#ifndef RR_TEST_PACKING_H
#define RR_TEST_PACKING_H

/* Elements of format 4 as a language binding would write and read them: what the test programs
 * need. */

#include "rr.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
  PACK_DOUBLE = 1,
  PACK_UINT8 = 4,
  PACK_INT32 = 7,
  PACK_UINT32 = 8,
  PACK_STRING = 11,
  PACK_DICTIONARY = 103,
  PACK_POD_ARRAY = 110
};

/* Elements that are written one behind the other. */
typedef struct packer {
  uint8_t* bytes; /* on the heap; freed by packer_free */
  size_t size;
  uint32_t count;
} packer;

void packer_free(packer* to);
/* One element of `count` items, which take `size` bytes. */
void pack(packer* to, const char* name, uint16_t type, const void* items, size_t size,
          uint32_t count);
/* The same with the name of a named type; `payload` are the elements of `nested`. */
void pack_nested(packer* to, const char* name, uint16_t type, const char* type_name,
                 const packer* nested);
void pack_double(packer* to, const char* name, double value);
void pack_int32(packer* to, const char* name, int32_t value);
void pack_uint32(packer* to, const char* name, uint32_t value);
void pack_text(packer* to, const char* name, const char* text);
rr_elements packed(const packer* from);

/* One element as it lies in others. */
typedef struct unpacked {
  uint16_t type;
  uint32_t count;
  const uint8_t* payload;
  size_t size;
} unpacked;

/* The element of a name, or the first with NULL, in either format. 0 when there is none. */
int unpack(const rr_elements* from, const char* name, unpacked* element);
double unpack_double(const rr_elements* from, const char* name);
int32_t unpack_int32(const rr_elements* from, const char* name);
/* Whether it is this text. */
int unpack_is_text(const rr_elements* from, const char* name, const char* text);

rr_str str(const char* text);

#ifdef __cplusplus
}
#endif

#endif
