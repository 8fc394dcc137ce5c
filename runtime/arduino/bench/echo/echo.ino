// SPDX-License-Identifier: Apache-2.0
// What the tests of the line use.
#include <Robdef.h>

#include "example_echo/example_echo.h"

class Echo {
 public:
  rr::Status getValue(double& value) {
    value = value_;
    return rr::Status::Ok;
  }
  rr::Status setValue(double value) {
    value_ = value;
    return rr::Status::Ok;
  }
  rr::Status getCount(uint32_t& value) {
    value = count_;
    return rr::Status::Ok;
  }
  rr::Status add(double a, double b, double& result) {
    ++count_;
    hasAdded_ = true;
    result = a + b;
    return rr::Status::Ok;
  }
  rr::Status wait(uint16_t time) {
    delay(time);
    return rr::Status::Ok;
  }
  /// True once after each add().
  bool hasAdded() {
    const bool result = hasAdded_;
    hasAdded_ = false;
    return result;
  }
  uint32_t count() const { return count_; }

 private:
  double value_ = 0;
  uint32_t count_ = 0;
  bool hasAdded_ = false;
};

Echo echo;
example::echo::EchoService<Echo> service(echo);

void setup() {
  Serial.begin(BAUD);
  service.begin(Serial);
}

void loop() {
  service.poll();
  if (echo.hasAdded()) service.root().fireAdded(echo.count());
}
