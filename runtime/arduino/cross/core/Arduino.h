// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stddef.h>
#include <stdint.h>
#include <string.h>

/// Declarations of what sketches and library use of an Arduino core. The cores for SAMD, RP2040 and ESP8266 are no
/// packages of Debian; this says no more than what they have in common, and defines nothing.
#define PROGMEM
#define A0 14
#define INPUT 0
#define OUTPUT 1
#define INPUT_PULLUP 2
#define LOW 0
#define HIGH 1
class __FlashStringHelper;
#define F(text) (reinterpret_cast<const __FlashStringHelper*>(text))
#define strlen_P strlen
#define pgm_read_byte(address) (*reinterpret_cast<const uint8_t*>(address))

unsigned long millis();
unsigned long micros();
void delay(unsigned long milliseconds);
void delayMicroseconds(unsigned int microseconds);
void pinMode(uint8_t pin, uint8_t mode);
void digitalWrite(uint8_t pin, uint8_t value);
int digitalRead(uint8_t pin);
int analogRead(uint8_t pin);
void analogWrite(uint8_t pin, int value);

class Print {
 public:
  virtual ~Print();
  virtual size_t write(uint8_t byte) = 0;
  virtual size_t write(const uint8_t* bytes, size_t count);
  virtual int availableForWrite();
  virtual void flush();
};

class Stream : public Print {
 public:
  virtual int available() = 0;
  virtual int read() = 0;
  virtual int peek() = 0;
};

class HardwareSerial : public Stream {
 public:
  void begin(unsigned long baud);
  size_t write(uint8_t byte);
  int available();
  int read();
  int peek();
  int availableForWrite();
  void flush();
};
extern HardwareSerial Serial;

void setup();
void loop();
