// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>

#include "compiler/driver/options.hpp"

namespace robdef {

/// What `robdef` answers to the program that started it.
enum ExitStatus : int {
  exit_fine = 0,
  exit_errors = 1,  ///< in a definition, a template folder, or in writing a file
  exit_usage = 2,   ///< the command line makes no sense
  exit_fault = 3,   ///< of this program
};

/// The pipeline: reads the definitions, runs all passes over them and delivers what the command
/// asks for. Products go to `out` or into files, findings to `err`; findings as JSON to `out`
/// unless the command prints there itself. With an error nothing but findings comes out.
ExitStatus compile(const Options& options, std::ostream& out, std::ostream& err);

}  // namespace robdef
