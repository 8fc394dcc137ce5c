// SPDX-License-Identifier: Apache-2.0
// The core with a serial port and nothing else: what sizes are compared with.
void setup() {
  Serial.begin(BAUD);
}

void loop() {
  if (Serial.available() > 0) Serial.write(Serial.read());
}
