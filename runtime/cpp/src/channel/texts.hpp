// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>

/// Texts that files of local nodes and announcements have in common (04, section 7.2; 05, section
/// 2.1).
namespace rr::channel {

/// Without the blanks around it.
std::string_view trimmed(std::string_view text);

/// A line `key: value`, both trimmed. An empty key for a line that is none.
std::pair<std::string_view, std::string_view> split_line(std::string_view line);

/// Sixteen letters and digits that nobody can guess: the name of a socket, the state of a node's
/// services.
std::string random_letters();

}  // namespace rr::channel
