// Serves example.echo. Written by robdef once, and yours since: fill in what the members do. When the
// definition changes, run robdef again: example_echo.h says which members there are then.
#include <Robdef.h>

#include "example_echo.h"

/// What the tests of the line use.
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
  /// Calls of add() since the board began.
  rr::Status getCount(uint32_t& value) {
    value = count_;
    return rr::Status::Ok;
  }
  rr::Status add(double a, double b, double& result) {
    (void)a;
    (void)b;
    (void)result;
    return rr::Status::NotImplemented;
  }
  /// Waits before it answers, in milliseconds.
  rr::Status wait(uint16_t time) {
    (void)time;
    return rr::Status::NotImplemented;
  }
  /// What comes goes back, and one more.
  rr::Status receiveCounts(uint32_t packet) {
    (void)packet;
    return rr::Status::NotImplemented;
  }
  void answeredDoubled(rr::Status status, double result) {
    (void)status;
    (void)result;
  }
  /// Asks the client for the double of it, which becomes the value.
  rr::Status ask(double question) {
    (void)question;
    return rr::Status::NotImplemented;
  }

 private:
  double value_ = double();
  uint32_t count_ = uint32_t();
};

Echo root;
::example::echo::EchoService<Echo> service(root);

void setup() {
  Serial.begin(115200);
  service.begin(Serial);
}

void loop() {
  service.poll();
}
