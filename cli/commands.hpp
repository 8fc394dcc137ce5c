// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compiler/driver/command_table.hpp"

namespace robdef {

/// The compiler's commands and those of this folder: all of `robdef`.
const CommandTable& all_commands();

}  // namespace robdef
