// SPDX-License-Identifier: Apache-2.0
// What service.json tells the panel to do, as a sketch.
#include <Robdef.h>

#include "conformance_board.h"

#ifndef BAUD
#define BAUD 115200
#endif

using conformance::board::Mode;

/// A lamp of the panel.
class Lamp {
 public:
  explicit Lamp(uint8_t level) : level_(level) {}

  rr::Status getLevel(uint8_t& value) {
    value = level_;
    return rr::Status::Ok;
  }
  rr::Status setLevel(uint8_t value) {
    level_ = value;
    return rr::Status::Ok;
  }
  rr::Status brighten(uint8_t level, uint8_t& result) {
    result = level;
    return rr::Status::Ok;
  }
  rr::Status fireBurntLater() {
    isBurnt_ = true;
    return rr::Status::Ok;
  }

  /// True once for each event that is wanted.
  bool takeBurnt() {
    const bool result = isBurnt_;
    isBurnt_ = false;
    return result;
  }

 private:
  uint8_t level_;
  bool isBurnt_ = false;
};

class Panel {
 public:
  Panel() {
    marks_.add(-1);
    marks_.add(300);
    report_.name = "first";
    report_.mode = Mode::moving;
    report_.where = {2, -2};
    report_.samples.add(0.5);
    report_.samples.add(1.5);
  }

  rr::Status getLit(bool& value) {
    value = lit_;
    return rr::Status::Ok;
  }
  rr::Status setLit(bool value) {
    lit_ = value;
    return rr::Status::Ok;
  }
  rr::Status getOffset(int8_t& value) {
    value = offset_;
    return rr::Status::Ok;
  }
  rr::Status setOffset(int8_t value) {
    offset_ = value;
    return rr::Status::Ok;
  }
  rr::Status getLevel(uint8_t& value) {
    value = level_;
    return rr::Status::Ok;
  }
  rr::Status setLevel(uint8_t value) {
    level_ = value;
    return rr::Status::Ok;
  }
  rr::Status getTrim(int16_t& value) {
    value = trim_;
    return rr::Status::Ok;
  }
  rr::Status setTrim(int16_t value) {
    trim_ = value;
    return rr::Status::Ok;
  }
  rr::Status getCount(uint16_t& value) {
    value = count_;
    return rr::Status::Ok;
  }
  rr::Status setCount(uint16_t value) {
    count_ = value;
    return rr::Status::Ok;
  }
  rr::Status getPosition(int32_t& value) {
    value = position_;
    return rr::Status::Ok;
  }
  rr::Status setPosition(int32_t value) {
    position_ = value;
    return rr::Status::Ok;
  }
  rr::Status getTotal(uint32_t& value) {
    value = total_;
    return rr::Status::Ok;
  }
  rr::Status setTotal(uint32_t value) {
    total_ = value;
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
  rr::Status getBigger(uint64_t& value) {
    value = bigger_;
    return rr::Status::Ok;
  }
  rr::Status setBigger(uint64_t value) {
    bigger_ = value;
    return rr::Status::Ok;
  }
  rr::Status getRatio(float& value) {
    value = ratio_;
    return rr::Status::Ok;
  }
  rr::Status setRatio(float value) {
    ratio_ = value;
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
  rr::Status getPhase(rr::Complex<float>& value) {
    value = phase_;
    return rr::Status::Ok;
  }
  rr::Status setPhase(const rr::Complex<float>& value) {
    phase_ = value;
    return rr::Status::Ok;
  }
  rr::Status getMode(::conformance::board::Mode& value) {
    value = mode_;
    return rr::Status::Ok;
  }
  rr::Status setMode(::conformance::board::Mode value) {
    mode_ = value;
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
  rr::Status getAddress(rr::Fixed<uint8_t, 4>& value) {
    value = address_;
    return rr::Status::Ok;
  }
  rr::Status setAddress(const rr::Fixed<uint8_t, 4>& value) {
    address_ = value;
    return rr::Status::Ok;
  }
  rr::Status getMarks(rr::Bounded<int16_t, 6>& value) {
    value = marks_;
    return rr::Status::Ok;
  }
  rr::Status setMarks(const rr::Bounded<int16_t, 6>& value) {
    marks_ = value;
    return rr::Status::Ok;
  }
  rr::Status getMatrix(rr::Fixed<float, 4>& value) {
    value = matrix_;
    return rr::Status::Ok;
  }
  rr::Status setMatrix(const rr::Fixed<float, 4>& value) {
    matrix_ = value;
    return rr::Status::Ok;
  }
  rr::Status getCorner(::conformance::board::parts::Point& value) {
    value = corner_;
    return rr::Status::Ok;
  }
  rr::Status setCorner(const ::conformance::board::parts::Point& value) {
    corner_ = value;
    return rr::Status::Ok;
  }
  rr::Status getCorners(rr::Fixed<::conformance::board::parts::Point, 2>& value) {
    value = corners_;
    return rr::Status::Ok;
  }
  rr::Status setCorners(const rr::Fixed<::conformance::board::parts::Point, 2>& value) {
    corners_ = value;
    return rr::Status::Ok;
  }
  rr::Status getTurn(::conformance::board::parts::Turn& value) {
    value = turn_;
    return rr::Status::Ok;
  }
  rr::Status setTurn(const ::conformance::board::parts::Turn& value) {
    turn_ = value;
    return rr::Status::Ok;
  }
  rr::Status getReport(::conformance::board::Report& value) {
    value = report_;
    return rr::Status::Ok;
  }
  rr::Status setReport(const ::conformance::board::Report& value) {
    report_ = value;
    return rr::Status::Ok;
  }
  rr::Status getSerial(uint32_t& value) {
    value = serial_;
    return rr::Status::Ok;
  }
  rr::Status setSecret(uint8_t value) {
    secret_ = value;
    return rr::Status::Ok;
  }
  rr::Status nothing() {
    return rr::Status::Ok;
  }
  rr::Status half(double& result) {
    result = 0.5;
    return rr::Status::Ok;
  }
  rr::Status echoWord(const rr::Text<8>& text, rr::Text<8>& result) {
    result = text;
    return rr::Status::Ok;
  }
  rr::Status echoReport(const ::conformance::board::Report& report, ::conformance::board::Report& result) {
    result = report;
    return rr::Status::Ok;
  }
  rr::Status jam() {
    return ::conformance::board::Jammed;
  }
  rr::Status chill() {
    return ::conformance::board::Cold;
  }
  rr::Status refuse() {
    return rr::refuse(rr::Status::OutOfRange, F("never"));
  }
  rr::Status callDoubledLater() {
    isDoubledWanted_ = true;
    return rr::Status::Ok;
  }
  void answeredDoubled(rr::Status status, double result) {
    doubled_ = status == rr::Status::Ok ? result : -static_cast<double>(status);
    hasDoubled_ = true;
  }
  rr::Status callSpellLater() {
    isSpellWanted_ = true;
    return rr::Status::Ok;
  }
  void answeredSpell(rr::Status status, const rr::Text<8>& result) {
    if (status == rr::Status::Ok) {
      spelled_ = result;
    } else {
      spelled_ = "refused";
    }
    hasSpelled_ = true;
  }
  rr::Status callCheckLater() {
    isCheckWanted_ = true;
    return rr::Status::Ok;
  }
  void answeredCheck(rr::Status status) {
    checked_ = status == ::conformance::board::Jammed ? Mode::broken : Mode::idle;
    hasChecked_ = true;
  }
  rr::Status fireMovedLater() {
    moves_ = 2;
    return rr::Status::Ok;
  }
  rr::Status receiveSamples(uint16_t packet) {
    (void)packet;
    ++received_;
    return rr::Status::Ok;
  }
  rr::Status sendSamplesLater() {
    packets_ = 2;
    return rr::Status::Ok;
  }
  rr::Status receivedCount(uint32_t& result) {
    result = received_;
    return rr::Status::Ok;
  }
  rr::Status getForce(int16_t& value) {
    value = force_;
    return rr::Status::Ok;
  }
  rr::Status sendForceLater() {
    force_ = 12;
    isForceWanted_ = true;
    return rr::Status::Ok;
  }
  rr::Status setTarget(double value) {
    if (value > 1e6) return rr::refuse(rr::Status::OutOfRange, F("at most a million"));
    target_ = value;
    return rr::Status::Ok;
  }
  rr::Status lastTarget(double& result) {
    result = target_;
    return rr::Status::Ok;
  }
  Lamp* top() { return &top_; }
  Lamp* lamp(uint8_t index) { return &lamp_[index]; }

  /// Says what there is to say. What there is no room for is said next time.
  template <class Sender>
  void speak(Sender sender) {
    if (moves_ == 2 && sender.fireMoved(100, Mode::moving)) moves_ = 1;
    if (moves_ == 1 && sender.fireMoved(-100, Mode::idle)) moves_ = 0;
    if (packets_ == 2 && sender.sendSamples(7)) packets_ = 1;
    if (packets_ == 1 && sender.sendSamples(65535)) packets_ = 0;
    if (isForceWanted_) sender.forceChanged();
    isForceWanted_ = false;
    if (isDoubledWanted_ && sender.askDoubled(21.25)) isDoubledWanted_ = false;
    if (hasDoubled_ && sender.fireAnsweredDoubled(doubled_)) hasDoubled_ = false;
    if (isSpellWanted_ && sender.askSpell("a b c")) isSpellWanted_ = false;
    if (hasSpelled_ && sender.fireAnsweredSpell(spelled_)) hasSpelled_ = false;
    if (isCheckWanted_ && sender.askCheck(Mode::moving)) isCheckWanted_ = false;
    if (hasChecked_ && sender.fireAnsweredCheck(checked_)) hasChecked_ = false;
  }

 private:
  bool lit_ = true;
  int8_t offset_ = -128;
  uint8_t level_ = 255;
  int16_t trim_ = -32767 - 1;
  uint16_t count_ = 65535;
  int32_t position_ = -2147483647 - 1;
  uint32_t total_ = 4294967295;
  int64_t big_ = -9223372036854775807 - 1;
  uint64_t bigger_ = 18446744073709551615u;
  float ratio_ = 0.15625;
  double exact_ = -1234.5;
  rr::Complex<float> phase_ = {0.5, -0.25};
  ::conformance::board::Mode mode_ = Mode::broken;
  rr::Text<16> text_ = "\xC2\xB5-panel";
  rr::Fixed<uint8_t, 4> address_ = {{10, 0, 0, 255}};
  rr::Bounded<int16_t, 6> marks_;
  rr::Fixed<float, 4> matrix_ = {{1, 0.5, -0.25, 0}};
  ::conformance::board::parts::Point corner_ = {1.5, -2.5};
  rr::Fixed<::conformance::board::parts::Point, 2> corners_ = {{{0, 0}, {0.5, 1}}};
  ::conformance::board::parts::Turn turn_ = {0.25, -0.5};
  ::conformance::board::Report report_;
  uint32_t serial_ = 4711;
  uint8_t secret_ = uint8_t();
  int16_t force_ = -5;
  double target_ = double();
  /// What loop() has to say.
  bool isForceWanted_ = false;
  bool isDoubledWanted_ = false;
  bool isSpellWanted_ = false;
  bool isCheckWanted_ = false;
  bool hasDoubled_ = false;
  bool hasSpelled_ = false;
  bool hasChecked_ = false;
  double doubled_ = 0;
  rr::Text<8> spelled_;
  Mode checked_ = Mode::idle;
  uint8_t moves_ = 0;
  uint8_t packets_ = 0;
  uint32_t received_ = 0;
  Lamp top_ = Lamp(1);
  Lamp lamp_[2] = {Lamp(10), Lamp(20)};
};

Panel panel;
::conformance::board::PanelService<Panel, Lamp> service(panel);

void setup() {
  Serial.begin(BAUD);
  service.begin(Serial);
}

void loop() {
  service.poll();
  panel.speak(service.root());
  if (panel.top()->takeBurnt()) service.top().fireBurnt(1000);
  for (uint8_t index = 0; index < 2; ++index) {
    if (panel.lamp(index)->takeBurnt()) service.lamp(index).fireBurnt(index == 0 ? 2000 : 3000);
  }
}
