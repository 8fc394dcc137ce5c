// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <iosfwd>
#include <span>
#include <string>
#include <string_view>

#include "compiler/driver/command_table.hpp"
#include "compiler/driver/compile.hpp"

namespace robdef {

/// A program with these commands but for where its arguments and streams come from.
/// `import_variable` is the value of ROBOTRACONTEUR_ROBDEF_PATH.
ExitStatus run(std::span<const std::string> arguments, std::string_view import_variable,
               const CommandTable& table, std::ostream& out, std::ostream& err);

/// The same with the arguments of main(), the environment and the standard streams.
int run_main(int count, char** words, const CommandTable& table);

/// Runs `work`. What it throws is a fault of this program: says so on `err`.
ExitStatus guard(const std::function<ExitStatus()>& work, std::ostream& err);

}  // namespace robdef
