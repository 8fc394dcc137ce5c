// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "rr/definition.hpp"
#include "rr/stub.hpp"

namespace rr::client {

/// A generator of which the service has told the number: the answer to a call of the member, which
/// must live as long.
std::shared_ptr<GeneratorState> make_generator(const Stub& stub, const Member& member,
                                               std::int32_t index);

}  // namespace rr::client
