// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace robdef {

/// The candidate that `written` was probably meant to be: the one that takes the fewest inserted,
/// removed, changed or swapped letters, upper and lower case taken as near. Of equally near ones
/// the first. Empty when all are too far off to be worth a word.
std::string_view nearest(std::string_view written, const std::vector<std::string_view>& candidates);

/// About how many letters nearest() compares for each candidate.
std::size_t comparisons(std::string_view written);

/// With the letters a to z as capitals.
std::string upper_case(std::string_view text);

}  // namespace robdef
