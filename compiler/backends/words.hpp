// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace robdef {

/// The words of a name: `move_to`, `moveTo` and `MoveTo` are `move`, `to`; `RGBLight2` is `RGB`,
/// `Light2`.
std::vector<std::string> words_of(std::string_view name);

/// `MoveTo`
std::string pascal_case(std::string_view name);
/// `moveTo`
std::string camel_case(std::string_view name);
/// `move_to`
std::string snake_case(std::string_view name);

/// The name with `p_` before it where it begins with no letter or `_`, or is empty: names of
/// parameters may, in definitions, and be left with nothing by a change of case.
std::string as_variable(std::string name);

/// The name in small letters when it has none: `max_points` for `MAX_POINTS`. Others stay.
std::string without_capitals(std::string_view name);

/// The segments of a dotted name.
std::vector<std::string> segments_of(std::string_view name);
/// The lines of a text, each with its line end.
std::vector<std::string_view> lines_of(std::string_view text);
/// `text` with every `from` replaced.
std::string replace_all(std::string_view text, std::string_view from, std::string_view to);
/// The pieces with `separator` between them.
std::string join(const std::vector<std::string>& pieces, std::string_view separator);

}  // namespace robdef
