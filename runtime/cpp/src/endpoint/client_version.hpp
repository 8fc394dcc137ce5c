// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "rr/definition.hpp"

namespace rr::endpoint {

/// What we say is our version: that of the implementation whose protocol this is.
inline constexpr std::string_view own_version = "1.2.8";

/// Two to four numbers with dots between. Throws rr::Error (service_definition_error).
DefinitionVersion parse_version(std::string_view text);

}  // namespace rr::endpoint
