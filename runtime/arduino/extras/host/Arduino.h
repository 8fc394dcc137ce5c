// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stddef.h>
#include <stdint.h>
#include <string.h>

/// What the library needs of an Arduino core, for a computer: tests run it there.
#define PROGMEM
#define F(text) reinterpret_cast<const __FlashStringHelper*>(text)
class __FlashStringHelper;
inline size_t strlen_P(const char* text) { return strlen(text); }
inline uint8_t pgm_read_byte(const void* address) { return *static_cast<const uint8_t*>(address); }

/// Milliseconds, as the test says.
uint32_t millis();
/// For programs made of a sketch.
void delay(uint32_t milliseconds);

class Stream {
 public:
  virtual ~Stream() = default;
  virtual int available() = 0;
  virtual int read() = 0;
  virtual size_t write(uint8_t byte) = 0;
  virtual int availableForWrite() { return 0; }
};
