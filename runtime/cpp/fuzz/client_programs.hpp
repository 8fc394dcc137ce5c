// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "runtime/cpp/fuzz/client_exchange.hpp"

/// Programs that use all that the definition of the fuzzers declares.
namespace rr::fuzz {

/// By generated code.
std::span<ClientProgram* const> client_programs();
/// Without, by the definitions that the service sends.
std::span<ClientProgram* const> dynamic_programs();
/// By the commands of the command line.
std::span<ClientProgram* const> command_programs();

}  // namespace rr::fuzz
