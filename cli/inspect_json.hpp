// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rr/recording.hpp>
#include <string>

namespace robdef {

/// A record as one JSON object on one line, values whole: numbers as JSON numbers, those of 64 bits
/// and complex ones as texts, bytes that are no message as hexadecimal digits.
std::string json_of(const rr::Record& record);

}  // namespace robdef
