// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Arduino.h>

#include <cstddef>
#include <cstdint>
#include <memory>

/// For tests: what a sketch needs of a network's library, over the sockets of this computer.
class WiFiClient {
 public:
  WiFiClient() = default;
  explicit WiFiClient(int file);

  explicit operator bool() const { return connection_ != nullptr; }
  bool connected();
  int available();
  int read();
  int peek();
  std::size_t write(const std::uint8_t* bytes, std::size_t count);
  void stop() { connection_.reset(); }

 private:
  struct Connection;

  /// Copies lead to the same connection, as those of the libraries do.
  std::shared_ptr<Connection> connection_;
};

/// Listens on the loopback interface.
class WiFiServer {
 public:
  /// 0: at a port that is free.
  explicit WiFiServer(std::uint16_t port) : port_(port) {}
  ~WiFiServer();
  WiFiServer(const WiFiServer&) = delete;
  WiFiServer& operator=(const WiFiServer&) = delete;

  /// Another port, before begin().
  void moveTo(std::uint16_t port) { port_ = port; }
  /// Ends the program when the port is taken.
  void begin();
  /// No connection where there is none.
  WiFiClient accept();
  /// Where it listens.
  std::uint16_t port() const { return port_; }

 private:
  std::uint16_t port_;
  int file_ = -1;
};
