// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "rr/error.hpp"
#include "runtime/cpp/src/serial/host_link.hpp"

/// What clients are told when a request to a board did not succeed.
namespace rr::serial {

/// The error for an outcome other than a reply, of a request for this member; `exceptions` are
/// those of the board's definition, qualified, in its order.
Error refusal_of(std::string_view member, const Outcome& outcome,
                 const std::vector<std::string>& exceptions);

/// The code of the serial protocol for an error that a client's callback has thrown.
std::uint8_t code_of(const Error& error, const std::vector<std::string>& exceptions);

}  // namespace rr::serial
