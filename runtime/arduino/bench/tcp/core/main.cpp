// SPDX-License-Identifier: Apache-2.0
// Runs a sketch as a program of this computer: board [PORT]. It prints the port, and ends when its
// standard input does.
#include <Arduino.h>
#include <WiFi.h>
#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

extern WiFiServer server;
void setup();
void loop();

std::uint32_t millis() {
  using std::chrono::duration_cast;
  const auto passed = std::chrono::steady_clock::now().time_since_epoch();
  return static_cast<std::uint32_t>(duration_cast<std::chrono::milliseconds>(passed).count());
}

void delay(std::uint32_t milliseconds) {
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

int main(int count, char** arguments) {
  if (count > 1) server.moveTo(static_cast<std::uint16_t>(std::strtoul(arguments[1], nullptr, 10)));
  setup();
  std::printf("%u\n", server.port());
  std::fflush(stdout);
  for (;;) {
    loop();
    pollfd input{STDIN_FILENO, POLLIN, 0};
    char byte = 0;
    if (::poll(&input, 1, 1) > 0 && ::read(STDIN_FILENO, &byte, 1) <= 0) return 0;
  }
}
