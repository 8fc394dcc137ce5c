// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "compiler/breaking/changes.hpp"
#include "compiler/diagnostics/source.hpp"

namespace robdef::breaking {

/// Number of the form of to_json(). It grows when something that is there changes its meaning or is
/// left out; what is added does not count.
inline constexpr int json_version = 1;

/// All changes for people, in the form of diagnostics, with their number at the end. Empty when
/// there are none.
std::string to_text(const Changes& changes, const Sources& sources);

/// One JSON object: breaking_version, old and new (what was compared), changes (code, categories,
/// severity, message, old and new place, effect, help), count, omitted. A place is file, line,
/// column and end; that of the new side may be null.
std::string to_json(const Changes& changes, const Sources& sources, std::string_view before,
                    std::string_view now);

/// One command of a GitHub workflow for each change, which shows it at its place. Only places in
/// files of the working tree are named.
std::string to_github(const Changes& changes, const Sources& sources,
                      const std::function<bool(SourceId)>& is_file);

}  // namespace robdef::breaking
