// SPDX-License-Identifier: Apache-2.0
#include "cli/live/board_channel.hpp"

#include <rr/serial.hpp>

namespace robdef::live {

void add_board_channel(rr::NodeOptions& options) {
  options.channels.emplace("rr+serial", rr::serial_channel());
}

}  // namespace robdef::live
