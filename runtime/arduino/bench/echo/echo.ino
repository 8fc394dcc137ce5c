// SPDX-License-Identifier: Apache-2.0
// What the tests of the line use.
#include <Robdef.h>

#include "echo.hpp"

Echo echo;
example::echo::EchoService<Echo> service(echo);

void setup() {
  Serial.begin(BAUD);
  service.begin(Serial);
}

void loop() {
  service.poll();
  sayWhatIsDue(echo, service);
}
