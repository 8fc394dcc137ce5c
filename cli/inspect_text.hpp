// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <rr/recording.hpp>
#include <string>

namespace robdef {

/// One line without its end: when, which connection, which way, and what.
std::string line_of(const rr::Record& record);

/// Seconds with six decimals.
std::string seconds_text(std::chrono::nanoseconds time);

/// What an error code is called: `ConnectionError`, `error 500`; empty for none.
std::string error_word(rr::ErrorCode code);

/// The name that a definition gives itself; empty when there is none.
std::string service_of_definition(std::string_view text);

/// `client`, `service` or `between`.
std::string_view word_of(rr::TapSide side);

}  // namespace robdef
