// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "runtime/cpp/src/dynamic/nodes.hpp"

/// Values as boards pack them, docs/reference/serial-protocol.md, "Values".
namespace rr::serial {

/// Appends a value of exactly this type. Throws rr::Error: null_value for a struct that is null,
/// buffer_limit_violation for what is longer than a frame can say.
void pack(const dynamic::TypeNode& type, const dynamic::Value& value,
          std::vector<std::uint8_t>& bytes);

/// Takes a value from the beginning of `bytes`, which is moved behind it. Throws rr::Error
/// (data_serialization_error) when there is none.
dynamic::Value unpack(const dynamic::TypeNode& type, std::span<const std::uint8_t>& bytes);

}  // namespace rr::serial
