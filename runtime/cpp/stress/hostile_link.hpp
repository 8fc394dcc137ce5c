// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rr/node_id.hpp"
#include "rr/reader.hpp"
#include "rr/writer.hpp"

namespace rr::stress {

using Bytes = std::vector<std::byte>;

/// One entry of a message, in format 2.
struct HostileEntry {
  EntryType type = EntryType::null;
  std::string path;
  std::string member;
  std::uint32_t id = 1;
  /// Writes the elements, last first; returns how many.
  std::function<std::uint32_t(Writer&)> elements{};
};

/// A message that any link can send.
Bytes make_message(const std::vector<HostileEntry>& entries);

/// A connection to a node, as a client that keeps to no rule has one.
class HostileLink {
 public:
  /// From one of several addresses of the loopback interface, by the number. Not connected when the
  /// node refuses it.
  HostileLink(std::uint16_t port, const NodeId& server, int number);
  ~HostileLink();
  HostileLink(HostileLink&& other) noexcept;
  HostileLink& operator=(HostileLink&&) = delete;

  /// Receives little: the system then keeps little of what is not read.
  void read_slowly();
  /// Sends for so long at most; returns how many bytes have left.
  std::size_t send(std::span<const std::byte> bytes, std::chrono::milliseconds limit);
  /// The same for a message, or the begin of one, that make_message() has made.
  std::size_t send_made(std::span<const std::byte> message, std::chrono::milliseconds limit);
  std::size_t send(const std::vector<HostileEntry>& entries) {
    return send_made(make_message(entries), std::chrono::milliseconds(1'500));
  }
  /// Connects to a service without logging in. False when the node does not answer.
  bool connect(const std::string& service);
  /// The next message; empty when none comes in time.
  Bytes receive(std::chrono::milliseconds limit);
  /// Drops what has come.
  void drop_received();
  /// A number of the answer to a request.
  bool ask_index(const HostileEntry& entry, std::int32_t& index);

 private:
  bool receive_exactly(std::span<std::byte> bytes, std::chrono::steady_clock::time_point deadline);

  const NodeId own_ = NodeId::random();
  const NodeId server_;
  std::uint32_t endpoint_ = 0;
  int socket_ = -1;
};

}  // namespace rr::stress
