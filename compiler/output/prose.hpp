// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace robdef {

/// Cuts documentation into lines of at most `width` characters, each of which begins with `mark`:
/// prose("A long text", "/// ", 40). Line ends of the text stay, so lists and tables survive; only
/// lines that are too long are broken, at blanks, and go on with the blanks that they began with. A
/// word that does not fit stands alone. Blanks at line ends go.
std::vector<std::string> prose(std::string_view text, std::string_view mark, std::size_t width);

}  // namespace robdef
