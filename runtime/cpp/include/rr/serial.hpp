// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "rr/visibility.hpp"

namespace RR_VISIBLE rr {

class MessageChannel;
class Node;

/// Where a board is.
struct BoardPlace {
  std::string path;             ///< of the port, `/dev/ttyACM0`, or `tcp://host:port`
  std::uint32_t baud = 115200;  ///< 9600 to 1000000, as the sketch has it; not for TCP
  std::string name{};           ///< of the service; empty: that of the sketch's root

  /// Reads `PATH`, `PATH?baud=9600&name=lamp`, with or without `rr+serial://` in front, and
  /// `tcp://host:port?name=lamp`, which is `rr+serial://host:port` as a URL. Throws rr::Error
  /// (invalid_argument).
  static BoardPlace parse(const std::string& text);
};

/// The channel that leads to boards at this machine's serial ports, and to those that speak the
/// same over TCP:
///
///   rr::Node node({.channels = {{"rr+serial", rr::serial_channel()}}});
///   auto light = node.connect<LightStub>("rr+serial:///dev/ttyUSB0?baud=115200");
///   auto lamp = node.connect<LightStub>("rr+serial://192.168.1.20:4000");
///
/// The URL may name the service, as `service=Light`; there is one only. While a client is connected
/// the process has the port for itself, and all clients in it share it, whichever node they are of.
/// They see what they would see through BoardBridge. Connecting throws connection_error when the
/// port cannot be opened, when another program has it, and when no board answers in time.
std::shared_ptr<MessageChannel> serial_channel();

/// Offers boards, at serial ports or over TCP, as services of a node (docs/howto/serial.md). A
/// board's service is offered when the board is met for the first time, and stays: while the board
/// is away, or is being reset, calls fail with connection_error. When it comes back with another
/// definition, the service is closed and offered anew.
class BoardBridge {
 public:
  /// Told of what happens, on the board's thread: `light: connected`.
  using Log = std::function<void(const std::string&)>;

  /// The node has to outlive the bridge.
  explicit BoardBridge(Node& node, Log log = {});
  /// Closes the services of all boards.
  ~BoardBridge();
  BoardBridge(const BoardBridge&) = delete;
  BoardBridge& operator=(const BoardBridge&) = delete;

  /// Does not wait for the board. Throws rr::Error (invalid_argument) for a rate that there is not.
  void add(const BoardPlace& place);
  /// Waits until all boards have been met. False when the time is over before.
  bool wait(std::chrono::milliseconds limit) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace rr
