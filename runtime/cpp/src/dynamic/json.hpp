// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "runtime/cpp/src/dynamic/nodes.hpp"

/// Values as JSON: docs/howto/dynamic.md says how each kind looks.
namespace rr::dynamic {

/// What JSON has, as it stands there: null, bool, numbers (int64, uint64, double), strings, lists,
/// string maps. Throws rr::Error (invalid_argument).
Value parse_json(std::string_view json);
/// Whether it is `{"type": text, "value": any}`, which says what a varvalue holds.
bool is_typed_json(const Value& value);
/// A null type means that none is known.
void write_json(const Value& value, const TypeNode* type, std::string& text);

}  // namespace rr::dynamic
