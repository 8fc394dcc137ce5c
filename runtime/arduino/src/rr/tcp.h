// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Arduino.h>
#include <stdint.h>
#include <string.h>

namespace rr {

/// The line of a board over TCP, for a service to begin with in place of a serial port. `Client` is
/// what the network's library calls a connection: WiFiClient, EthernetClient.
///
///   WiFiServer server(4000);
///   rr::TcpLine<WiFiClient> line;
///
///   void setup() { /* join the network */ server.begin(); service.begin(line); }
///   void loop() {
///     if (line.accept(server.accept())) service.begin(line);
///     service.poll();
///     line.flush();
///   }
///
/// Anybody who reaches the port is served: it has no password and is not encrypted. It belongs into
/// a network of its own, with a bridge that asks for users and TLS.
template <class Client>
class TcpLine : public Stream {
 public:
  /// Takes a connection, if it is one. True when it has become the line, with which the service
  /// begins anew. There is one host at a time: another one is closed, unless nothing has come from
  /// the first for three seconds, in which it would have asked whether the board is there.
  bool accept(Client next) {
    if (!next) return false;
    if (client_.connected() && static_cast<uint32_t>(millis()) - heardAt_ < patience) {
      next.stop();
      return false;
    }
    client_.stop();
    client_ = next;
    count_ = 0;
    heardAt_ = static_cast<uint32_t>(millis());
    return true;
  }
  bool isConnected() { return client_.connected(); }

  int available() { return client_.available(); }
  int read() {
    heardAt_ = static_cast<uint32_t>(millis());
    return client_.read();
  }
  int peek() { return client_.peek(); }
  /// What is written is gathered: each write to a client may be a packet of its own.
  size_t write(uint8_t byte) {
    if (count_ == sizeof gathered_) return 0;
    gathered_[count_++] = byte;
    return 1;
  }
  int availableForWrite() { return static_cast<int>(sizeof gathered_) - count_; }
  /// Sends what has been gathered.
  void flush() {
    if (count_ == 0) return;
    // Nobody is there to take it.
    if (!client_.connected()) count_ = 0;
    const size_t sent = count_ == 0 ? 0 : client_.write(gathered_, count_);
    count_ = static_cast<uint8_t>(sent < count_ ? count_ - sent : 0);
    memmove(gathered_, gathered_ + sent, count_);
  }

 private:
  /// A host asks after a second of silence.
  static constexpr uint32_t patience = 3000;

  Client client_;
  uint32_t heardAt_ = 0;
  uint8_t count_ = 0;
  uint8_t gathered_[128];
};

}  // namespace rr
