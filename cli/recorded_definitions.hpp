// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/syntax/read.hpp"

namespace robdef {

/// What a recording begins with (docs/howto/recording.md).
inline constexpr std::string_view recording_mark = "RRTAPE";

/// The service definitions that a recording holds, each text once. Says on `err` when the file is
/// cut off or damaged. Throws rr::Error when it cannot be read, and VersionError when it holds no
/// definitions, or more bytes of them than a session may have.
std::vector<ast::NamedText> recorded_definitions(const std::string& path, std::ostream& err);

}  // namespace robdef
