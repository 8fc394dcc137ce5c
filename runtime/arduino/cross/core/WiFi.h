// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Arduino.h>

/// Declarations of what sketches use of a library for WiFi, as core/Arduino.h for the core.
#define WL_CONNECTED 3

class WiFiClient : public Stream {
 public:
  WiFiClient();
  WiFiClient(const WiFiClient& other);
  WiFiClient& operator=(const WiFiClient& other);
  ~WiFiClient();
  operator bool();
  uint8_t connected();
  void stop();
  size_t write(uint8_t byte);
  size_t write(const uint8_t* bytes, size_t count);
  int available();
  int read();
  int peek();
  void flush();
};

class WiFiServer {
 public:
  explicit WiFiServer(uint16_t port);
  void begin();
  WiFiClient accept();
};

class WiFiClass {
 public:
  int begin(const char* network, const char* password);
  int status();
};
extern WiFiClass WiFi;
