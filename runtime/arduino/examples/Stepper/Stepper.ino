// SPDX-License-Identifier: Apache-2.0
// A stepper motor with a switch at each end, served over the serial port. A driver with step and
// direction inputs is on pins 2 and 3; the switches are on 4 and 5 and pull them to ground.
#include <Robdef.h>

#include "example_stepper.h"

#ifndef BAUD
#define BAUD 115200
#endif

using example::stepper::Limit;

const uint8_t stepPin = 2;
const uint8_t directionPin = 3;
const uint8_t lowPin = 4;
const uint8_t highPin = 5;

class Motor {
 public:
  void begin() {
    pinMode(stepPin, OUTPUT);
    pinMode(directionPin, OUTPUT);
    pinMode(lowPin, INPUT_PULLUP);
    pinMode(highPin, INPUT_PULLUP);
  }

  rr::Status getPosition(int32_t& value) {
    value = position_;
    return rr::Status::Ok;
  }
  rr::Status getTravel(int32_t& value) {
    return getPosition(value);
  }
  rr::Status getSpeed(uint16_t& value) {
    value = speed_;
    return rr::Status::Ok;
  }
  rr::Status setSpeed(uint16_t value) {
    if (value < 1 || value > 2000) {
      return rr::refuse(rr::Status::OutOfRange, F("1 to 2000 steps a second"));
    }
    speed_ = value;
    return rr::Status::Ok;
  }
  rr::Status getLimit(Limit& value) {
    value = limit();
    return rr::Status::Ok;
  }
  rr::Status home() {
    isHomed_ = false;
    isHoming_ = true;
    isMoving_ = true;
    return rr::Status::Ok;
  }
  rr::Status moveTo(int32_t target) {
    if (!isHomed_) {
      return rr::refuse(example::stepper::NotHomed, F("call home, and wait until it has ended"));
    }
    target_ = target;
    isMoving_ = true;
    return rr::Status::Ok;
  }
  rr::Status stop() {
    target_ = position_;
    isHoming_ = false;
    return rr::Status::Ok;
  }

  /// Makes a step when it is time for one. True once when the motor has come to rest.
  bool advance() {
    if (!isMoving_) return false;
    const bool isUp = !isHoming_ && target_ > position_;
    const Limit pressed = limit();
    const bool isBlocked = pressed == (isUp ? Limit::high : Limit::low);
    if (isBlocked || (!isHoming_ && target_ == position_)) {
      if (isHoming_ && isBlocked) {
        position_ = 0;
        isHomed_ = true;
      }
      isHoming_ = false;
      isMoving_ = false;
      return true;
    }
    const uint32_t now = micros();
    if (now - lastStep_ < 1000000UL / speed_) return false;
    lastStep_ = now;
    digitalWrite(directionPin, isUp ? HIGH : LOW);
    digitalWrite(stepPin, HIGH);
    digitalWrite(stepPin, LOW);
    position_ += isUp ? 1 : -1;
    return false;
  }
  bool isMoving() const {
    return isMoving_;
  }
  int32_t position() const {
    return position_;
  }
  Limit limit() const {
    if (digitalRead(lowPin) == LOW) return Limit::low;
    return digitalRead(highPin) == LOW ? Limit::high : Limit::none;
  }

 private:
  int32_t position_ = 0;
  int32_t target_ = 0;
  uint32_t lastStep_ = 0;
  uint16_t speed_ = 500;
  bool isHomed_ = false;
  bool isHoming_ = false;
  bool isMoving_ = false;
};

Motor motor;
example::stepper::StepperService<Motor> service(motor);
uint32_t lastReport = 0;

void setup() {
  Serial.begin(BAUD);
  motor.begin();
  service.begin(Serial);
}

void loop() {
  service.poll();
  if (motor.advance()) service.root().fireArrived(motor.position(), motor.limit());
  if (motor.isMoving() && millis() - lastReport >= 50) {
    lastReport = millis();
    service.root().travelChanged();
  }
}
