// Serves example.light. Written by robdef once, and yours since: fill in what the members do. When the
// definition changes, run robdef again: example_light.h says which members there are then.
#include <Robdef.h>

#include "example_light.h"

/// A lamp of three colours and a light sensor.
class Light {
 public:
  /// Each part from 0 to 1.
  rr::Status getColor(::example::light::Color& value) {
    value = color_;
    return rr::Status::Ok;
  }
  rr::Status setColor(const ::example::light::Color& value) {
    color_ = value;
    return rr::Status::Ok;
  }
  /// In lux.
  rr::Status getBrightness(double& value) {
    value = brightness_;
    return rr::Status::Ok;
  }
  /// Go to a colour, in up to 60 seconds.
  rr::Status fade(const ::example::light::Color& target, double duration) {
    (void)target;
    (void)duration;
    return rr::Status::NotImplemented;
  }
  /// Ten times a second.
  rr::Status getSensor(double& value) {
    value = sensor_;
    return rr::Status::Ok;
  }

 private:
  ::example::light::Color color_ = ::example::light::Color();
  double brightness_ = double();
  double sensor_ = double();
};

Light root;
::example::light::LightService<Light> service(root);

void setup() {
  Serial.begin(115200);
  service.begin(Serial);
}

void loop() {
  service.poll();
}
