// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compiler/diagnostics/report.hpp"
#include "compiler/diagnostics/source.hpp"

namespace robdef {

/// A label to be drawn under its line of source.
struct Marking {
  const Label* label = nullptr;
  bool is_primary = false;
};

/// The lines of one source that hold the labels, each followed by one line of marks for each of its
/// labels, in the order of lines. `gutter` is the width of the largest line number.
std::string excerpt(const Source& source, std::vector<Marking> markings, std::size_t gutter);

/// Text as it can be printed: tabs and control characters become blanks, what is not UTF-8 `?`.
std::string printable(std::string_view text);

}  // namespace robdef
