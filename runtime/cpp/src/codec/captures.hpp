// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "rr/wire.hpp"

/// The recorded bytes that the tests of the codec run over; the format is described in the README
/// of conformance/captures.
namespace rr::captures {

/// One message of a scenario.
struct Frame {
  std::string name;  ///< scenario, version and number, for messages of failures
  MessageVersion agreed = MessageVersion::v2;  ///< of the connection; a message may have another
  bool string_table = false;                   ///< agreed for the connection
  std::vector<std::byte> bytes;
  nlohmann::json decoded;
};

/// One element of the values files.
struct Value {
  std::string name;
  std::vector<std::byte> bytes;
};

/// One input of malformed.json.
struct Malformed {
  std::string name;
  MessageVersion version = MessageVersion::v2;
  std::string result;  ///< closed, answered or nothing
  std::vector<std::byte> bytes;
};

/// The messages of all scenarios but those over web sockets.
std::vector<Frame> frames();
/// The messages of the scenarios whose file name ends so ("v4st.json").
std::vector<Frame> frames(std::string_view ending);
std::vector<Value> values(MessageVersion version);
std::vector<Malformed> malformed();

/// Bytes from hexadecimal text; spaces are skipped.
std::vector<std::byte> from_hex(std::string_view hex);

}  // namespace rr::captures
