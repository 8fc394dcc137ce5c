// SPDX-License-Identifier: Apache-2.0
#include "compiler/lsp/protocol.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace robdef::lsp {
namespace {

[[noreturn]] void refuse(const char* key, const char* wanted) {
  throw RequestError(ErrorCode::invalid_params,
                     std::string("`") + key + "` is missing or is not " + wanted);
}

}  // namespace

const Json& part_of(const Json& object, const char* key) {
  if (!object.is_object()) refuse(key, "there");
  const auto found = object.find(key);
  if (found == object.end()) refuse(key, "there");
  return *found;
}

std::string text_of(const Json& object, const char* key) {
  const Json& value = part_of(object, key);
  if (!value.is_string()) refuse(key, "a string");
  return value.get<std::string>();
}

std::uint32_t number_of(const Json& object, const char* key) {
  const Json& value = part_of(object, key);
  const bool is_natural =
      value.is_number_integer() && (value.is_number_unsigned() || value.get<std::int64_t>() >= 0);
  if (!is_natural) refuse(key, "a natural number");
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(
      value.get<std::uint64_t>(), std::numeric_limits<std::uint32_t>::max()));
}

const Json& at_path(const Json& object, std::initializer_list<const char*> keys) {
  static const Json nothing;
  const Json* at = &object;
  for (const char* key : keys) {
    if (!at->is_object()) return nothing;
    const auto found = at->find(key);
    if (found == at->end()) return nothing;
    at = &*found;
  }
  return *at;
}

bool is_true(const Json& object, const char* key) {
  const Json& value = at_path(object, {key});
  return value.is_boolean() && value.get<bool>();
}

Place place_from(const Json& json) {
  return {number_of(json, "line"), number_of(json, "character")};
}

Range range_from(const Json& json) {
  return {place_from(part_of(json, "start")), place_from(part_of(json, "end"))};
}

Json to_json(Place place) { return {{"line", place.line}, {"character", place.character}}; }

Json to_json(const Range& range) {
  return {{"start", to_json(range.start)}, {"end", to_json(range.end)}};
}

Json response(const Json& id, Json result) {
  return {{"jsonrpc", "2.0"}, {"id", id}, {"result", std::move(result)}};
}

Json error_response(const Json& id, ErrorCode code, std::string_view message) {
  return {{"jsonrpc", "2.0"},
          {"id", id},
          {"error", {{"code", static_cast<int>(code)}, {"message", std::string(message)}}}};
}

Json notification(const char* method, Json params) {
  return {{"jsonrpc", "2.0"}, {"method", method}, {"params", std::move(params)}};
}

}  // namespace robdef::lsp
