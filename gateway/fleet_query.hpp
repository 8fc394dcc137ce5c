// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "gateway/carrier.hpp"
#include "gateway/fleet.hpp"

namespace rr::gateway {

/// Asks a broker for the fleet: until nothing has come for `quiet`. Throws rr::Error
/// (connection_error) with the reason when the first attempt to connect fails, or lasts longer than
/// `limit`.
Fleet ask_for_fleet(Carrier& carrier, std::chrono::milliseconds limit,
                    std::chrono::milliseconds quiet);

}  // namespace rr::gateway
