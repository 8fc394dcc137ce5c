// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>

#include "compiler/driver/compile.hpp"
#include "compiler/driver/options.hpp"

namespace robdef {

/// Does what `robdef ca` was asked for, and prints the files that it has made.
ExitStatus run_authority(const Options& options, std::ostream& out, std::ostream& err);

}  // namespace robdef
