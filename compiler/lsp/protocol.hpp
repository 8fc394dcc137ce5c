// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>

/// The Language Server Protocol 3.17 as far as `robdef lsp` speaks it.
namespace robdef::lsp {

using Json = nlohmann::json;

/// Error codes of JSON-RPC and of the protocol.
enum class ErrorCode {
  parse_error = -32700,
  invalid_request = -32600,
  method_not_found = -32601,
  invalid_params = -32602,
  internal_error = -32603,
  server_not_initialized = -32002,
  request_cancelled = -32800,
  request_failed = -32803,
};

/// Why a request gets no result. Thrown by what handles one; the server answers with it.
class RequestError : public std::runtime_error {
 public:
  RequestError(ErrorCode code, const std::string& message)
      : std::runtime_error(message), code_(code) {}
  [[nodiscard]] ErrorCode code() const { return code_; }

 private:
  ErrorCode code_;
};

/// A place in a document: line from 0, and units of the agreed encoding from the line's begin.
struct Place {
  std::uint32_t line = 0;
  std::uint32_t character = 0;

  auto operator<=>(const Place&) const = default;
};

struct Range {
  Place start;
  Place end;

  bool operator==(const Range&) const = default;
};

// Parts of parameters. What is missing or has another type is RequestError invalid_params.
const Json& part_of(const Json& object, const char* key);
std::string text_of(const Json& object, const char* key);
/// Numbers beyond 32 bits become the largest.
std::uint32_t number_of(const Json& object, const char* key);
bool is_true(const Json& object, const char* key);  ///< false when it is missing
/// The value at a path of keys; null when any of them is missing.
const Json& at_path(const Json& object, std::initializer_list<const char*> keys);

Place place_from(const Json& json);
Range range_from(const Json& json);
Json to_json(Place place);
Json to_json(const Range& range);

Json response(const Json& id, Json result);
Json error_response(const Json& id, ErrorCode code, std::string_view message);
Json notification(const char* method, Json params);

}  // namespace robdef::lsp
