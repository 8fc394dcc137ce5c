// SPDX-License-Identifier: Apache-2.0
#include "cli/commands.hpp"
#include "compiler/driver/run.hpp"

int main(int count, char** words) { return robdef::run_main(count, words, robdef::all_commands()); }
