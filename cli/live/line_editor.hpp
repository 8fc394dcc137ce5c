// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "cli/live/line_reader.hpp"

namespace robdef::live {

/// Reads from the terminal with what the system has for that: editing, history, completion. Null
/// when it has nothing.
std::unique_ptr<LineReader> make_line_editor(Completer completer);

}  // namespace robdef::live
