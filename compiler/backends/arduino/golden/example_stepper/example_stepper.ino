// Serves example.stepper. Written by robdef once, and yours since: fill in what the members do. When the
// definition changes, run robdef again: example_stepper.h says which members there are then.
#include <Robdef.h>

#include "example_stepper.h"

/// A stepper motor on a spindle with a switch at each end.
class Stepper {
 public:
  /// Where it is, in steps from the low switch.
  rr::Status getPosition(int32_t& value) {
    value = position_;
    return rr::Status::Ok;
  }
  /// Steps a second, from 1 to 2000.
  rr::Status getSpeed(uint16_t& value) {
    value = speed_;
    return rr::Status::Ok;
  }
  rr::Status setSpeed(uint16_t value) {
    speed_ = value;
    return rr::Status::Ok;
  }
  /// The switch that is pressed.
  rr::Status getLimit(::example::stepper::Limit& value) {
    value = limit_;
    return rr::Status::Ok;
  }
  /// Go to the low switch, which becomes position 0.
  rr::Status home() {
    return rr::Status::NotImplemented;
  }
  /// Go to a position; the event says when it is there. Throws NotHomed before home() has ended.
  rr::Status moveTo(int32_t target) {
    (void)target;
    return rr::Status::NotImplemented;
  }
  rr::Status stop() {
    return rr::Status::NotImplemented;
  }
  /// The motor has come to rest, by itself or at a switch.
  /// Where it is, twenty times a second while it moves.
  rr::Status getTravel(int32_t& value) {
    value = travel_;
    return rr::Status::Ok;
  }

 private:
  int32_t position_ = int32_t();
  uint16_t speed_ = uint16_t();
  ::example::stepper::Limit limit_ = ::example::stepper::Limit();
  int32_t travel_ = int32_t();
};

Stepper root;
::example::stepper::StepperService<Stepper> service(root);

void setup() {
  Serial.begin(115200);
  service.begin(Serial);
}

void loop() {
  service.poll();
}
