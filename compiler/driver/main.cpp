// SPDX-License-Identifier: Apache-2.0
// The compiler alone: `robdef` of a build with ROBDEF_COMPILER_ONLY.
#include "compiler/driver/run.hpp"

int main(int count, char** words) {
  return robdef::run_main(count, words, robdef::compiler_commands());
}
