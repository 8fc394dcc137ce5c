// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "rr/definition.hpp"
#include "rr/stub.hpp"

namespace rr::client {

/// A generator of which the service has told the number: the answer to a call of the member, which
/// must live as long.
std::shared_ptr<GeneratorState> make_generator(const Stub& stub, const Member& member,
                                               std::int32_t index);

/// Tells the service to break off a generator, without waiting. Throws nothing.
void abort_generator(Session& session, const std::string& path, const std::string& member,
                     std::int32_t index) noexcept;

}  // namespace rr::client
