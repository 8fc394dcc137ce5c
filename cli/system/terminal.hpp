// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

/// The terminal of the program, or the console, and what it opens for its user.
namespace robdef::system {

/// Whether standard output, or standard input, is one.
[[nodiscard]] bool writes_to_terminal();
[[nodiscard]] bool reads_from_terminal();

/// Asks at the terminal, whatever the standard streams are, and shows nothing of what is typed.
/// Nothing without a terminal.
std::optional<std::string> ask_silently(const std::string& question);

/// What is next in a descriptor that was handed to this program, up to the end of a line. Nothing
/// when it cannot be read.
std::optional<std::string> line_from_descriptor(int descriptor);

/// Shows an address in the user's browser, where there is a display.
void open_in_browser(const std::string& address);

/// Makes an empty file among the temporary ones, which its user alone may read: its path; empty
/// when it cannot.
std::string make_temporary_file();

}  // namespace robdef::system
