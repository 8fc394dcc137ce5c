// SPDX-License-Identifier: Apache-2.0
// A lamp of three colours and a sensor of light, served over the serial port. The lamp's parts are on
// pins 9, 10 and 11 (behind transistors), the sensor is on A0.
//
//   robdef bridge --board /dev/ttyACM0
//
// makes it a service that any client can use.
#include <Robdef.h>

#include "example_light.h"

#ifndef BAUD
#define BAUD 115200
#endif

using example::light::Color;

const uint8_t redPin = 9;
const uint8_t greenPin = 10;
const uint8_t bluePin = 11;
const uint8_t sensorPin = A0;
/// Lux for each step of the converter.
const double luxOfStep = 0.5;

class Lamp {
 public:
  void begin() {
    pinMode(redPin, OUTPUT);
    pinMode(greenPin, OUTPUT);
    pinMode(bluePin, OUTPUT);
    show();
  }

  rr::Status getColor(Color& value) {
    value = color_;
    return rr::Status::Ok;
  }
  rr::Status setColor(const Color& value) {
    if (!isPart(value.red) || !isPart(value.green) || !isPart(value.blue)) {
      return rr::Status::OutOfRange;
    }
    isFading_ = false;
    color_ = value;
    show();
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
    if (!isPart(target.red) || !isPart(target.green) || !isPart(target.blue)) {
      return rr::Status::OutOfRange;
    }
    if (!(duration >= 0) || duration > 3600) return rr::Status::OutOfRange;
    from_ = color_;
    to_ = target;
    begun_ = millis();
    duration_ = static_cast<uint32_t>(duration * 1000);
    isFading_ = true;
    return rr::Status::Ok;
  }

  /// True once when a fade has ended.
  bool advance() {
    if (!isFading_) return false;
    const uint32_t passed = millis() - begun_;
    if (passed < duration_) {
      const float part = static_cast<float>(passed) / static_cast<float>(duration_);
      color_.red = from_.red + part * (to_.red - from_.red);
      color_.green = from_.green + part * (to_.green - from_.green);
      color_.blue = from_.blue + part * (to_.blue - from_.blue);
      show();
      return false;
    }
    color_ = to_;
    isFading_ = false;
    show();
    return true;
  }
  const Color& color() const {
    return color_;
  }

 private:
  static bool isPart(float value) {
    return value >= 0 && value <= 1;
  }
  void show() {
    analogWrite(redPin, static_cast<int>(color_.red * 255));
    analogWrite(greenPin, static_cast<int>(color_.green * 255));
    analogWrite(bluePin, static_cast<int>(color_.blue * 255));
  }

  Color color_ = {0, 0, 0};
  Color from_ = {0, 0, 0};
  Color to_ = {0, 0, 0};
  uint32_t begun_ = 0;
  uint32_t duration_ = 0;
  bool isFading_ = false;
};

Lamp lamp;
example::light::LightService<Lamp> service(lamp);
uint32_t lastSample = 0;

void setup() {
  Serial.begin(BAUD);
  lamp.begin();
  service.begin(Serial);
}

void loop() {
  service.poll();
  if (lamp.advance()) service.root().fireFaded(lamp.color());
  if (millis() - lastSample >= 100) {
    lastSample = millis();
    service.root().sensorChanged();
  }
}
