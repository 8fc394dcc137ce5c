// SPDX-License-Identifier: Apache-2.0
// Frames for the runners of languages over the C interface: there a program never sees a frame, its
// native library reads and writes them. A shared library of two functions.
#include <cstdlib>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <string>

#include "conformance/harness/decoded.hpp"
#include "conformance/harness/hex.hpp"

namespace rr::conformance {
namespace {

MessageVersion version_of(const Json& request) {
  return request.at("message_version") == 2 ? MessageVersion::v2 : MessageVersion::v4;
}

Json decode(const Json& request) {
  const Bytes bytes = bytes_of_hex(request.at("hex").get<std::string>());
  if (request.at("do") == "message") {
    MessageTree message;
    if (!read_tree(bytes, message)) throw std::runtime_error("not a message");
    return {{"decoded", json_of_message(message)}};
  }
  ElementTree element;
  const MessageVersion version = version_of(request);
  if (!read_element_tree(bytes, version, element)) throw std::runtime_error("not an element");
  return {{"decoded", json_of_element(element, version)}};
}

Json encode(const Json& request) {
  std::vector<std::byte> bytes;
  if (request.at("do") == "message") {
    bytes = write_tree(message_of_json(request.at("decoded")));
  } else {
    const MessageVersion version = version_of(request);
    bytes = write_element_tree(element_of_json(request.at("decoded"), version), version);
  }
  if (bytes.empty()) throw std::runtime_error("does not fit the format");
  return {{"hex", hex_of_bytes(bytes)}};
}

}  // namespace
}  // namespace rr::conformance

extern "C" {

/// The answer to a line {do: message or element, ...} of `decode` (it has `hex`) or `encode` (it
/// has `decoded`), as conformance/README.md says, or {error}. To be freed with conformance_free;
/// NULL without memory.
__attribute__((visibility("default"))) char* conformance_answer(const char* line);
__attribute__((visibility("default"))) void conformance_free(char* text);

char* conformance_answer(const char* line) {
  using rr::conformance::Json;
  try {
    Json answer;
    try {
      const Json request = Json::parse(line);
      answer = request.contains("hex") ? rr::conformance::decode(request)
                                       : rr::conformance::encode(request);
    } catch (const std::exception& error) {
      answer = {{"error", error.what()}};
    }
    return strdup(answer.dump(-1, ' ', false, Json::error_handler_t::replace).c_str());
  } catch (const std::exception&) {
    return nullptr;
  }
}

void conformance_free(char* text) { std::free(text); }

}  // extern "C"
