// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

/// Pieces of messages.
namespace robdef::model {

/// A name in backquotes.
std::string in_ticks(std::string_view name);
/// `a`, `b` and `c`
std::string listed(const std::vector<std::string>& names);
/// a struct, an object
std::string with_article(std::string_view noun);

}  // namespace robdef::model
