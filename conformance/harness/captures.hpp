// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "conformance/harness/hex.hpp"
#include "conformance/harness/json.hpp"
#include "conformance/harness/web_socket_recording.hpp"

/// A folder in the format of the captures (captures/README.md), read and checked.
namespace rr::conformance {

/// One recorded message.
struct Frame {
  int number = 0;
  int connection = 0;
  bool from_client = false;
  Bytes bytes;
  Json decoded;  ///< texts and node ids written out, names of types left out

  [[nodiscard]] const Json& header() const { return decoded.at("header"); }
  [[nodiscard]] const Json& entries() const { return decoded.at("entries"); }
  [[nodiscard]] int entry_type() const;  ///< of the first entry; -1 without one
};

struct Connection {
  std::uint32_t client_endpoint = 0;   ///< 0 when it never had one
  std::uint32_t service_endpoint = 0;  ///< likewise
  int closed_after_frame = -1;         ///< -1: the recording does not say
  bool closed_by_client = true;
};

struct Step {
  int index = 0;
  std::string label;
  Json plan;                   ///< what the recorded client did; null in hand-made scenarios
  bool is_unanswered = false;  ///< hand-made: the recorded service stayed silent, and alive
  int first_frame = 0;
  int frame_count = 0;
};

struct Node {
  std::string id;  ///< without braces
  std::string name;
};

struct Scenario {
  std::string name;
  std::string version;  ///< v2, v4 or v4st
  std::string about;
  int message_version = 2;
  bool string_table = false;
  WebSocketRecording web_socket;  ///< what lay around the messages; mostly empty
  bool hand_made = false;
  Node service;
  Node client;
  Json node_options;  ///< null when nothing was changed
  Json heartbeat_ms;  ///< {client, service}, or null
  std::vector<Connection> connections;
  std::vector<Step> steps;
  std::vector<Frame> frames;
};

/// One value alone, as it is packed in one message version.
struct Value {
  std::string name;
  int message_version = 2;
  std::string type;
  Json value;
  Json element;                ///< element_name or element_number, metadata, extended (hex)
  std::optional<Bytes> bytes;  ///< nothing when the recorded library refuses to pack it
};

struct MalformedCase {
  std::string name;
  int message_version = 2;
  bool connected = false;  ///< else nothing was sent before
  std::string hex;         ///< with {ep}; empty with a recipe
  Json recipe;
  int pieces = 1;
  std::string result;  ///< closed, answered, nothing
  Json answers;
  std::string connection_test_after;
};

struct Captures {
  std::filesystem::path folder;
  Blobs blobs;
  Json service;  ///< service.json; null in a folder without one
  std::vector<Scenario> scenarios;
  std::vector<Value> values;
  std::vector<MalformedCase> malformed;

  [[nodiscard]] const Scenario* find(std::string_view name, std::string_view version) const;
};

/// Reads the whole folder. Throws std::runtime_error that names the file at fault.
Captures read_captures(const std::filesystem::path& folder);

/// Reads one JSON file; throws std::runtime_error that names it.
Json read_json(const std::filesystem::path& file);

/// Writes the service definitions of a folder, each as it travels (with the text of blobs.json
/// where it has one), and one more whose only object has a property of every type that the values
/// of the folder are of: what generated adapters are made from. Returns the names of the files
/// written.
std::vector<std::string> write_definitions(const std::filesystem::path& captures,
                                           const std::filesystem::path& output);

}  // namespace rr::conformance
