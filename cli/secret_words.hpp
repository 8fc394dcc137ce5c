// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

/// Passwords and passphrases that the user gives.
namespace robdef {

/// The first line of a file; of `/dev/fd/N`, what is next in that descriptor. Throws rr::Error
/// (io_error).
std::string first_line(const std::string& path);

/// Asks at the terminal of the program, whatever its standard streams are, and shows nothing of
/// what is typed. Without a terminal throws rr::Error (authentication_error) with `otherwise`.
std::string ask_silently(const std::string& question, const std::string& otherwise);

}  // namespace robdef
