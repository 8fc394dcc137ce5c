// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace robdef::project {

/// Whether a path has `*`, `?` or `[` in it.
bool is_pattern(std::string_view path);

/// The files that a pattern fits, sorted. `*`, `?` and `[a-z]` stand for letters of one name, `**`
/// for folders of any depth, also none; those that begin with a dot are not meant, and links to
/// folders are not followed by `**`.
std::vector<std::string> matching_files(const std::string& pattern);

}  // namespace robdef::project
