// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <iosfwd>
#include <string_view>

#include "compiler/driver/compile.hpp"
#include "compiler/driver/options.hpp"

/// The commands that use a running service, known by its URL alone
/// (docs/reference/command_line.md).
namespace robdef {

/// How much of an error's text is printed: a service has written it.
inline constexpr std::size_t longest_message = 2000;

/// Whether an argument is a URL and not a file.
bool is_url(std::string_view text);

/// `describe`, `get`, `set`, `call`, `watch`, `connect` and `complete`, at the service at the URL
/// that is their first argument.
ExitStatus run_live(const Options& options, std::ostream& out, std::ostream& err);

}  // namespace robdef
