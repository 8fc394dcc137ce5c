// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rr/dynamic.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "cli/live/object_path.hpp"

namespace robdef::live {

/// What `word`, the beginning of a member's path, may become for a command such as `get`: members
/// that it takes, and objrefs, which end with `.` or `[`. Paths begin at `base`. Sorted. Throws
/// rr::Error.
std::vector<std::string> completions(const rr::dynamic::Object& root, const ObjectPath& base,
                                     std::string_view command, std::string_view word);

/// The longest text that all begin with.
std::string common_beginning(const std::vector<std::string>& words);

}  // namespace robdef::live
