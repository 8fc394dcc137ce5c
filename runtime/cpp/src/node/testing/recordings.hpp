// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rr/node_id.hpp"
#include "rr/recording.hpp"

/// What tests of recordings read and write.
namespace rr::testing {

/// A folder of one test, removed at its end.
class RecordingFolder {
 public:
  RecordingFolder();
  ~RecordingFolder();
  RecordingFolder(const RecordingFolder&) = delete;
  RecordingFolder& operator=(const RecordingFolder&) = delete;
  std::string operator/(std::string_view name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

std::string read_file(const std::string& path);
void write_file(const std::string& path, std::string_view text);

/// A whole recording, by what it is made of.
struct Recorded {
  RecordingEnd end = RecordingEnd::open;
  std::map<std::uint32_t, ConnectionOpened> opened;
  std::map<std::uint32_t, ConnectionAgreed> agreed;
  std::map<std::uint32_t, ConnectionClosed> closed;
  /// By connection and direction.
  std::map<std::pair<std::uint32_t, Direction>, std::vector<std::vector<std::byte>>> messages;
  std::uint64_t message_count = 0;
  std::vector<std::uint64_t> replaced;
  std::vector<std::string> definitions;
  MessagesLost lost;
};

Recorded read_recorded(const std::string& path);

/// Where two recordings of the same connections do not have the same messages, byte for byte; empty
/// when they do. Connections are told apart by the URL of their client.
std::string difference_of_messages(const Recorded& one, const Recorded& other);

/// A client of the wire `trace` of a service `wired` that reads nothing once it is connected.
class StuckWireClient {
 public:
  StuckWireClient(std::uint16_t port, const NodeId& server);
  ~StuckWireClient();
  StuckWireClient(const StuckWireClient&) = delete;
  StuckWireClient& operator=(const StuckWireClient&) = delete;

 private:
  int socket_ = -1;
};

}  // namespace rr::testing
