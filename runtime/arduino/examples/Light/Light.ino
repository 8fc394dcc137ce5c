// SPDX-License-Identifier: Apache-2.0
// A lamp of three colours and a sensor of light, served over the serial port. The lamp's parts are on
// pins 9, 10 and 11 (behind transistors), the sensor is on A0.
//
//   robdef bridge /dev/ttyACM0 --listen 6257
//
// makes it a service that any client can use.
#include <Robdef.h>

#include "example_light.h"

#ifndef BAUD
#define BAUD 115200
#endif

using example::light::Color;

/// Red, green, blue.
const uint8_t pins[3] = {9, 10, 11};
const uint8_t sensorPin = A0;
/// Lux for each step of the converter.
const double luxOfStep = 0.5;

class Lamp {
 public:
  rr::Status getColor(Color& value) {
    value = color_;
    return rr::Status::Ok;
  }
  rr::Status setColor(const Color& value) {
    if (!isColor(value)) return refuseColor();
    aim(value);
    rest();
    return rr::Status::Ok;
  }
  rr::Status getBrightness(double& value) {
    value = analogRead(sensorPin) * luxOfStep;
    return rr::Status::Ok;
  }
  rr::Status getSensor(double& value) {
    return getBrightness(value);
  }
  rr::Status fade(const Color& target, double duration) {
    if (!isColor(target)) return refuseColor();
    if (!(duration >= 0) || duration > 60) {
      return rr::refuse(rr::Status::OutOfRange, F("a fade takes 0 to 60 seconds"));
    }
    aim(target);
    begun_ = static_cast<uint16_t>(millis());
    duration_ = static_cast<uint16_t>(duration * 1000);
    isFading_ = true;
    return rr::Status::Ok;
  }

  /// Goes on with a fade. True once when it has ended.
  bool advance() {
    if (!isFading_) return false;
    const uint16_t passed = static_cast<uint16_t>(millis()) - begun_;
    if (passed < duration_) {
      // In steps of 1/256: whole numbers are quick.
      show((static_cast<uint32_t>(passed) << 8) / duration_);
      return false;
    }
    rest();
    return true;
  }
  const Color& color() const {
    return color_;
  }

 private:
  static bool isPart(float value) {
    return value >= 0 && value <= 1;
  }
  static bool isColor(const Color& value) {
    return isPart(value.red) && isPart(value.green) && isPart(value.blue);
  }
  static rr::Status refuseColor() {
    return rr::refuse(rr::Status::OutOfRange, F("the parts of a colour are from 0 to 1"));
  }
  static uint8_t levelOf(float part) {
    return static_cast<uint16_t>(part * 255);
  }
  void aim(const Color& target) {
    target_ = target;
    to_[0] = levelOf(target.red);
    to_[1] = levelOf(target.green);
    to_[2] = levelOf(target.blue);
  }
  /// What is so many 256th of the way to the target.
  void show(uint16_t part) {
    for (uint8_t index = 0; index < 3; ++index) {
      // Modulo 65,536 on the way, and right at its end.
      const uint16_t way = static_cast<uint16_t>(to_[index] - from_[index]) * part;
      const uint16_t sum = (static_cast<uint16_t>(from_[index]) << 8) + way;
      analogWrite(pins[index], sum >> 8);
    }
  }
  void rest() {
    show(256);
    memcpy(from_, to_, sizeof from_);
    color_ = target_;
    isFading_ = false;
  }

  /// The one that was reached last.
  Color color_ = {0, 0, 0};
  Color target_ = {0, 0, 0};
  /// Levels of the pins.
  uint8_t from_[3] = {0, 0, 0};
  uint8_t to_[3] = {0, 0, 0};
  /// In milliseconds.
  uint16_t begun_ = 0;
  uint16_t duration_ = 0;
  bool isFading_ = false;
};

Lamp lamp;
example::light::LightService<Lamp> service(lamp);
uint16_t lastSample = 0;

void setup() {
  Serial.begin(BAUD);
  service.begin(Serial);
}

void loop() {
  service.poll();
  if (lamp.advance()) service.root().fireFaded(lamp.color());
  const uint16_t now = static_cast<uint16_t>(millis());
  if (static_cast<uint16_t>(now - lastSample) >= 100) {
    lastSample = now;
    service.root().sensorChanged();
  }
}
