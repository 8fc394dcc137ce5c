// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "rr/visibility.hpp"

namespace rr::codec {

/// Adds a string of JSON, with its quotes. A peer's text cannot end its line or steer a terminal:
/// control characters are escaped, and bytes that are no UTF-8 become U+FFFD. Beyond `longest`
/// bytes it is cut.
RR_INSIDE void add_json_text(std::string& line, std::string_view text, std::size_t longest);

}  // namespace rr::codec
