// SPDX-License-Identifier: Apache-2.0
// A lamp of three colours and a sensor of light, served over TCP by a board with WiFi (ESP32, ESP8266, Nano
// RP2040 Connect, MKR 1010). Clients use it by
//
//   rr+serial://ADDRESS:4000
//
// or through a bridge: robdef bridge tcp://ADDRESS:4000 --listen 6257
#if defined(ESP8266)
#include <ESP8266WiFi.h>
#elif defined(ARDUINO_ARCH_SAMD) || defined(ARDUINO_ARCH_MBED)
#include <WiFiNINA.h>
#else
#include <WiFi.h>
#endif
#include <Robdef.h>
#include <rr/tcp.h>

#include "example_light.h"

using example::light::Color;

char network[] = "name of the network";
char password[] = "its password";

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
    return fade(value, 0);
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
      return rr::refuse(rr::Status::OutOfRange, F("the parts of a colour are from 0 to 1"));
    }
    if (!(duration >= 0) || duration > 60) {
      return rr::refuse(rr::Status::OutOfRange, F("a fade takes 0 to 60 seconds"));
    }
    from_ = color_;
    target_ = target;
    begun_ = millis();
    duration_ = static_cast<uint32_t>(duration * 1000);
    isFading_ = duration_ != 0;
    if (!isFading_) show(1);
    return rr::Status::Ok;
  }

  /// Goes on with a fade. True once when it has ended.
  bool advance() {
    if (!isFading_) return false;
    const uint32_t passed = static_cast<uint32_t>(millis()) - begun_;
    isFading_ = passed < duration_;
    show(isFading_ ? static_cast<float>(passed) / static_cast<float>(duration_) : 1);
    return !isFading_;
  }
  const Color& color() const {
    return color_;
  }

 private:
  static bool isPart(float value) {
    return value >= 0 && value <= 1;
  }
  /// Such a part of the way to the target.
  void show(float part) {
    color_.red = from_.red + (target_.red - from_.red) * part;
    color_.green = from_.green + (target_.green - from_.green) * part;
    color_.blue = from_.blue + (target_.blue - from_.blue) * part;
    analogWrite(pins[0], static_cast<int>(color_.red * 255));
    analogWrite(pins[1], static_cast<int>(color_.green * 255));
    analogWrite(pins[2], static_cast<int>(color_.blue * 255));
  }

  Color color_ = {0, 0, 0};
  Color from_ = {0, 0, 0};
  Color target_ = {0, 0, 0};
  uint32_t begun_ = 0;
  /// In milliseconds.
  uint32_t duration_ = 0;
  bool isFading_ = false;
};

Lamp lamp;
example::light::LightService<Lamp> service(lamp);
WiFiServer server(4000);
rr::TcpLine<WiFiClient> line;
uint32_t lastSample = 0;

void setup() {
  WiFi.begin(network, password);
  while (WiFi.status() != WL_CONNECTED) delay(100);
  server.begin();
  service.begin(line);
}

void loop() {
  // In cores older than ESP32 2.0 and ESP8266 3.1 this is server.available().
  if (line.accept(server.accept())) service.begin(line);
  service.poll();
  line.flush();
  if (lamp.advance()) service.root().fireFaded(lamp.color());
  const uint32_t now = millis();
  if (now - lastSample >= 100) {
    lastSample = now;
    service.root().sensorChanged();
  }
}
