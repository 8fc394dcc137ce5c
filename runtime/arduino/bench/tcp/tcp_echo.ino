// SPDX-License-Identifier: Apache-2.0
// The echo over TCP, as a board with WiFi serves it.
#include <Robdef.h>
#include <WiFi.h>
#include <rr/tcp.h>

#include "../echo/echo.hpp"

Echo echo;
example::echo::EchoService<Echo> service(echo);
WiFiServer server(0);
rr::TcpLine<WiFiClient> line;

void setup() {
  server.begin();
  service.begin(line);
}

void loop() {
  if (line.accept(server.accept())) service.begin(line);
  service.poll();
  line.flush();
  sayWhatIsDue(echo, service);
}
