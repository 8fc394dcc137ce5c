// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rr/options.hpp>

namespace robdef::live {

/// Adds what URLs of boards need, `rr+serial`, where the system has it.
void add_board_channel(rr::NodeOptions& options);

}  // namespace robdef::live
