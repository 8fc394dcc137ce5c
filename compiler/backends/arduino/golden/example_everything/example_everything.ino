// Serves example.everything. Written by robdef once, and yours since: fill in what the members do. When the
// definition changes, run robdef again: example_everything.h says which members there are then.
#include <Robdef.h>

#include "example_everything.h"

/// One of three lamps.
class Lamp {
 public:
  rr::Status getLevel(uint8_t& value) {
    value = level_;
    return rr::Status::Ok;
  }
  rr::Status setLevel(uint8_t value) {
    level_ = value;
    return rr::Status::Ok;
  }
  rr::Status blink(uint8_t times) {
    (void)times;
    return rr::Status::NotImplemented;
  }
  rr::Status getGlow(uint8_t& value) {
    value = glow_;
    return rr::Status::Ok;
  }
  rr::Status setGlow(uint8_t value) {
    glow_ = value;
    return rr::Status::Ok;
  }

 private:
  uint8_t level_ = uint8_t();
  uint8_t glow_ = uint8_t();
};

class Motor {
 public:
  rr::Status getSpeed(double& value) {
    value = speed_;
    return rr::Status::Ok;
  }
  rr::Status setSpeed(double value) {
    speed_ = value;
    return rr::Status::Ok;
  }
  Lamp* lamp() { return &lamp_; }

 private:
  double speed_ = double();
  Lamp lamp_;
};

class Board {
 public:
  rr::Status getOn(bool& value) {
    value = on_;
    return rr::Status::Ok;
  }
  rr::Status setOn(bool value) {
    on_ = value;
    return rr::Status::Ok;
  }
  rr::Status getSmall(int8_t& value) {
    value = small_;
    return rr::Status::Ok;
  }
  rr::Status setSmall(int8_t value) {
    small_ = value;
    return rr::Status::Ok;
  }
  rr::Status getWord(uint16_t& value) {
    value = word_;
    return rr::Status::Ok;
  }
  rr::Status setWord(uint16_t value) {
    word_ = value;
    return rr::Status::Ok;
  }
  rr::Status getBig(int64_t& value) {
    value = big_;
    return rr::Status::Ok;
  }
  rr::Status setBig(int64_t value) {
    big_ = value;
    return rr::Status::Ok;
  }
  rr::Status getUnsignedBig(uint64_t& value) {
    value = unsignedBig_;
    return rr::Status::Ok;
  }
  rr::Status setUnsignedBig(uint64_t value) {
    unsignedBig_ = value;
    return rr::Status::Ok;
  }
  rr::Status getRatio(float& value) {
    value = ratio_;
    return rr::Status::Ok;
  }
  rr::Status getExact(double& value) {
    value = exact_;
    return rr::Status::Ok;
  }
  rr::Status setExact(double value) {
    exact_ = value;
    return rr::Status::Ok;
  }
  rr::Status getMode(::example::everything::Mode& value) {
    value = mode_;
    return rr::Status::Ok;
  }
  rr::Status setMode(::example::everything::Mode value) {
    mode_ = value;
    return rr::Status::Ok;
  }
  rr::Status getReport(::example::everything::Report& value) {
    value = report_;
    return rr::Status::Ok;
  }
  rr::Status setReport(const ::example::everything::Report& value) {
    report_ = value;
    return rr::Status::Ok;
  }
  rr::Status getCorners(rr::Fixed<::example::shapes::Point, 3>& value) {
    value = corners_;
    return rr::Status::Ok;
  }
  rr::Status setCorners(const rr::Fixed<::example::shapes::Point, 3>& value) {
    corners_ = value;
    return rr::Status::Ok;
  }
  rr::Status getMatrix(rr::Fixed<double, 4>& value) {
    value = matrix_;
    return rr::Status::Ok;
  }
  rr::Status setMatrix(const rr::Fixed<double, 4>& value) {
    matrix_ = value;
    return rr::Status::Ok;
  }
  rr::Status getNumbers(rr::Bounded<int32_t, 5>& value) {
    value = numbers_;
    return rr::Status::Ok;
  }
  rr::Status setNumbers(const rr::Bounded<int32_t, 5>& value) {
    numbers_ = value;
    return rr::Status::Ok;
  }
  rr::Status getPhase(rr::Complex<double>& value) {
    value = phase_;
    return rr::Status::Ok;
  }
  rr::Status setPhase(const rr::Complex<double>& value) {
    phase_ = value;
    return rr::Status::Ok;
  }
  rr::Status getText(rr::Text<16>& value) {
    value = text_;
    return rr::Status::Ok;
  }
  rr::Status setText(const rr::Text<16>& value) {
    text_ = value;
    return rr::Status::Ok;
  }
  rr::Status setSecret(uint8_t value) {
    secret_ = value;
    return rr::Status::Ok;
  }
  rr::Status greet(const rr::Text<8>& name, rr::Text<20>& result) {
    (void)name;
    (void)result;
    return rr::Status::NotImplemented;
  }
  rr::Status add(double a, double b, double& result) {
    (void)a;
    (void)b;
    (void)result;
    return rr::Status::NotImplemented;
  }
  rr::Status fail(uint8_t how) {
    (void)how;
    return rr::Status::NotImplemented;
  }
  rr::Status receiveCommands(uint8_t packet) {
    (void)packet;
    return rr::Status::NotImplemented;
  }
  void answeredConfirm(rr::Status status, bool result) {
    (void)status;
    (void)result;
  }
  void answeredTold(rr::Status status) {
    (void)status;
  }
  rr::Status getPosition(::example::everything::Vector& value) {
    value = position_;
    return rr::Status::Ok;
  }
  rr::Status setTarget(double value) {
    target_ = value;
    return rr::Status::Ok;
  }
  rr::Status getBoth(int16_t& value) {
    value = both_;
    return rr::Status::Ok;
  }
  rr::Status setBoth(int16_t value) {
    both_ = value;
    return rr::Status::Ok;
  }
  Motor* motor() { return &motor_; }
  Lamp* lamp(uint8_t index) { return &lamp_[index]; }

 private:
  bool on_ = bool();
  int8_t small_ = int8_t();
  uint16_t word_ = uint16_t();
  int64_t big_ = int64_t();
  uint64_t unsignedBig_ = uint64_t();
  float ratio_ = float();
  double exact_ = double();
  ::example::everything::Mode mode_ = ::example::everything::Mode();
  ::example::everything::Report report_ = ::example::everything::Report();
  rr::Fixed<::example::shapes::Point, 3> corners_ = rr::Fixed<::example::shapes::Point, 3>();
  rr::Fixed<double, 4> matrix_ = rr::Fixed<double, 4>();
  rr::Bounded<int32_t, 5> numbers_ = rr::Bounded<int32_t, 5>();
  rr::Complex<double> phase_ = rr::Complex<double>();
  rr::Text<16> text_ = rr::Text<16>();
  uint8_t secret_ = uint8_t();
  ::example::everything::Vector position_ = ::example::everything::Vector();
  double target_ = double();
  int16_t both_ = int16_t();
  Motor motor_;
  Lamp lamp_[3];
};

Board root;
::example::everything::BoardService<Board, Motor, Lamp> service(root);

void setup() {
  Serial.begin(115200);
  service.begin(Serial);
}

void loop() {
  service.poll();
}
