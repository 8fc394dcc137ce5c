// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "conformance/harness/hex.hpp"
#include "conformance/harness/json.hpp"
#include "rr/wire.hpp"

/// Single numbers in the notation of the captures: integers are JSON numbers, those of 64 bits are
/// texts, bool is true or false, complex is [re, im]. Floats are the shortest decimal that gives
/// the same bits; "NaN", "Infinity", "-Infinity", and "NaN:0x..." for a NaN with other bits.
namespace rr::conformance {

Json json_of_double(double value);
Json json_of_single(float value);
/// Both throw std::runtime_error for anything that is no such number.
double double_of_json(const Json& json);
float single_of_json(const Json& json);

/// Reads an integer, a number or a text of one; throws std::runtime_error when it does not fit `T`.
template <class T>
T integer_of_json(const Json& json);

/// The list of numbers in a packed payload of a number type, and back. `payload` holds whole items.
/// Nothing for a bool byte that is neither 0 nor 1.
Json json_of_numbers(rr::ElementType type, std::span<const std::byte> payload);
Bytes numbers_of_json(rr::ElementType type, const Json& list);

}  // namespace rr::conformance
