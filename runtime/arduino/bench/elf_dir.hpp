// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace rr::serial::testing {

/// Where the programs of the boards are, with a slash at its end.
inline const std::string elf_dir = RR_ELF_DIR;

}  // namespace rr::serial::testing
