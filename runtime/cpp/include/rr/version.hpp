// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "rr/visibility.hpp"

/// The version of these headers; `tools/version` writes it.
#define RR_VERSION "0.1.0"
/// Of it the part that changes when programs must be written anew in places.
#define RR_VERSION_MAJOR 0
/// Of it the part that changes when something is new.
#define RR_VERSION_MINOR 1
/// Of it the part that changes when something is mended.
#define RR_VERSION_PATCH 0

namespace RR_VISIBLE rr {

/// The version of the library that the program runs with, as `0.1.0`. It is another one than
/// RR_VERSION when a shared library was replaced after the program was compiled.
[[nodiscard]] std::string_view library_version();

}  // namespace rr
