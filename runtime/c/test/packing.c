/* SPDX-License-Identifier: Apache-2.0 */
#include "packing.h"

#include <stdlib.h>
#include <string.h>

rr_str str(const char* text) {
  rr_str result;
  result.data = text;
  result.size = strlen(text);
  return result;
}

void packer_free(packer* to) {
  free(to->bytes);
  memset(to, 0, sizeof *to);
}

static uint8_t* grow(packer* to, size_t size) {
  uint8_t* at;
  to->bytes = realloc(to->bytes, to->size + size);
  if (to->bytes == NULL) abort();
  at = to->bytes + to->size;
  to->size += size;
  return at;
}

/* How many bytes a number of variable length takes, and writing it (02, section 1). */
static size_t length_of(size_t number) { return number <= 252 ? 1 : number <= 0xFFFF ? 3 : 5; }

static uint8_t* put_number(uint8_t* at, size_t number) {
  size_t i;
  const size_t length = length_of(number);
  if (length == 1) {
    *at = (uint8_t)number;
    return at + 1;
  }
  *at++ = length == 3 ? 253 : 254;
  for (i = 0; i < length - 1; ++i) *at++ = (uint8_t)(number >> (8 * i));
  return at;
}

static uint8_t* put_text(uint8_t* at, const char* text) {
  const size_t size = strlen(text);
  at = put_number(at, size);
  memcpy(at, text, size);
  return at + size;
}

static void put_element(packer* to, const char* name, uint16_t type, const char* type_name,
                        const void* payload, size_t size, uint32_t count) {
  const size_t name_size = strlen(name);
  const size_t type_size = type_name != NULL ? strlen(type_name) : 0;
  const size_t type_part = type_name != NULL ? length_of(type_size) + type_size : 0;
  const size_t rest =
      1 + length_of(name_size) + name_size + 2 + type_part + length_of(count) + size;
  size_t whole = rest + 1;
  uint8_t* at;
  if (rest + 1 > 252) whole = rest + 3;
  if (whole > 0xFFFF) whole = rest + 5;
  at = grow(to, whole);
  at = put_number(at, whole);
  *at++ = (uint8_t)(0x01 | (type_name != NULL ? 0x08 : 0));
  at = put_text(at, name);
  *at++ = (uint8_t)(type & 0xFF);
  *at++ = (uint8_t)(type >> 8);
  if (type_name != NULL) at = put_text(at, type_name);
  at = put_number(at, count);
  if (size != 0) memcpy(at, payload, size);
  ++to->count;
}

void pack(packer* to, const char* name, uint16_t type, const void* items, size_t size,
          uint32_t count) {
  put_element(to, name, type, NULL, items, size, count);
}

void pack_nested(packer* to, const char* name, uint16_t type, const char* type_name,
                 const packer* nested) {
  put_element(to, name, type, type_name, nested->bytes, nested->size, nested->count);
}

void pack_double(packer* to, const char* name, double value) {
  pack(to, name, PACK_DOUBLE, &value, sizeof value, 1);
}

void pack_int32(packer* to, const char* name, int32_t value) {
  pack(to, name, PACK_INT32, &value, sizeof value, 1);
}

void pack_uint32(packer* to, const char* name, uint32_t value) {
  pack(to, name, PACK_UINT32, &value, sizeof value, 1);
}

void pack_text(packer* to, const char* name, const char* text) {
  const size_t size = strlen(text);
  pack(to, name, PACK_STRING, text, size, (uint32_t)size);
}

rr_elements packed(const packer* from) {
  rr_elements result;
  result.data = from->bytes;
  result.size = from->size;
  result.count = from->count;
  result.version = 4;
  return result;
}

static size_t get_number(const uint8_t** at, size_t bytes) {
  size_t number = 0;
  size_t i;
  for (i = 0; i < bytes; ++i) number |= (size_t) * (*at)++ << (8 * i);
  return number;
}

static size_t get_compact(const uint8_t** at) {
  const uint8_t first = *(*at)++;
  if (first <= 252) return first;
  return get_number(at, first == 253 ? 2 : first == 254 ? 4 : 8);
}

/* The name's bytes; the rest of the header is passed over. */
static rr_str get_header(uint32_t version, const uint8_t** at, const uint8_t** end,
                         unpacked* element) {
  const uint8_t* const begin = *at;
  rr_str name = {NULL, 0};
  if (version == 2) {
    *end = begin + get_number(at, 4);
    name.size = get_number(at, 2);
    name.data = (const char*)*at;
    *at += name.size;
    element->type = (uint16_t)get_number(at, 2);
    *at += get_number(at, 2); /* type name */
    *at += get_number(at, 2); /* metadata */
    element->count = (uint32_t)get_number(at, 4);
    return name;
  }
  *end = begin + get_compact(at);
  {
    const uint8_t flags = *(*at)++;
    if (flags & 0x01) {
      name.size = get_compact(at);
      name.data = (const char*)*at;
      *at += name.size;
    }
    if (flags & 0x04) get_compact(at); /* number: longer ones do not occur here */
    element->type = (uint16_t)get_number(at, 2);
    if (flags & 0x08) *at += get_compact(at);
    if (flags & 0x20) *at += get_compact(at);
    element->count = (uint32_t)get_compact(at);
  }
  return name;
}

int unpack(const rr_elements* from, const char* name, unpacked* element) {
  const uint8_t* at = from->data;
  uint32_t i;
  for (i = 0; i < from->count; ++i) {
    const uint8_t* end = NULL;
    const rr_str found = get_header(from->version, &at, &end, element);
    element->payload = at;
    element->size = (size_t)(end - at);
    at = end;
    if (name == NULL || (found.size == strlen(name) && memcmp(found.data, name, found.size) == 0)) {
      return 1;
    }
  }
  memset(element, 0, sizeof *element);
  return 0;
}

double unpack_double(const rr_elements* from, const char* name) {
  unpacked element;
  double value = 0;
  if (unpack(from, name, &element) && element.size == sizeof value) {
    memcpy(&value, element.payload, sizeof value);
  }
  return value;
}

int32_t unpack_int32(const rr_elements* from, const char* name) {
  unpacked element;
  int32_t value = 0;
  if (unpack(from, name, &element) && element.size == sizeof value) {
    memcpy(&value, element.payload, sizeof value);
  }
  return value;
}

int unpack_is_text(const rr_elements* from, const char* name, const char* text) {
  unpacked element;
  return unpack(from, name, &element) && element.type == PACK_STRING &&
         element.size == strlen(text) && memcmp(element.payload, text, element.size) == 0;
}
