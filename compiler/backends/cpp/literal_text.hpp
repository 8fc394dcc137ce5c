// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace robdef::cpp {

/// A definition's text as string literals that C++ joins to exactly these bytes: raw ones as far as
/// possible, so that the text stays readable, of at most 16 kB each; a byte order mark, carriage
/// returns and what else a raw literal may not keep in ordinary ones.
std::vector<std::string> literal_text(std::string_view text);

}  // namespace robdef::cpp
