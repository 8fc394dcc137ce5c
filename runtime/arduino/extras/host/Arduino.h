// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stddef.h>
#include <stdint.h>

/// What the library needs of an Arduino core, for a computer: tests run it there.
#define PROGMEM
inline uint8_t pgm_read_byte(const void* address) { return *static_cast<const uint8_t*>(address); }

/// Milliseconds, as the test says.
uint32_t millis();

class Stream {
 public:
  virtual ~Stream() = default;
  virtual int available() = 0;
  virtual int read() = 0;
  virtual size_t write(uint8_t byte) = 0;
  virtual int availableForWrite() { return 0; }
};
