// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runtime/cpp/src/replay/stream.hpp"
#include "runtime/cpp/src/replay/unit.hpp"

namespace rr::replay {

/// A connection while it is played: what has come and was not expected yet, and what stands for
/// what.
class PlayedLine {
 public:
  void open(Stream stream) { stream_ = std::move(stream); }
  void close() { stream_.close(); }
  [[nodiscard]] bool is_open() const { return stream_.is_open(); }
  [[nodiscard]] int descriptor() const { return stream_.descriptor(); }

  /// Takes all messages that are there, and answers connection tests. True when any was.
  bool receive_all();
  /// Sends a recorded message of the played side, addressed to the live one.
  void send(const std::vector<std::byte>& recorded);

  /// Takes the unit that answers to the recorded one out of what has come; what may differ has been
  /// put aside in it. Nothing when it has not come.
  std::optional<Unit> take(const Unit& recorded);
  /// What has come and was not taken.
  [[nodiscard]] const std::deque<Unit>& left() const { return came_; }

 private:
  void learn(const Unit& recorded, const Unit& live);
  [[nodiscard]] std::vector<std::byte> addressed(MessageTree message) const;

  Stream stream_;
  std::deque<Unit> came_;
  Endpoints endpoints_;
  Generators generators_;
  std::map<std::uint32_t, std::uint32_t> requests_;     // of the live side, by recorded ones
  std::map<std::uint16_t, std::uint16_t> message_ids_;  // the same
  // Of the other side: recorded, live.
  std::optional<std::pair<NodeId, NodeId>> node_;
  std::pair<std::string, std::string> name_;
};

}  // namespace rr::replay
