// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace robdef {

/// For tests: the text with one to eight changes: of its layout, of its lines, and of single bytes.
/// The same seed gives the same changes.
std::string mutated(std::string text, std::uint64_t seed);

}  // namespace robdef
