// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "compiler/driver/command_table.hpp"

/// The rows of the commands that use a running service; all_commands() has them.
namespace robdef::live {

std::span<const CommandRow> commands();
std::span<const OptionRow> options();
/// A command that is for shells and not for people: in no list.
const CommandRow& completing_command();
/// What the help of these commands says behind their options.
extern const std::string_view help_notes;

/// What options of connecting are missing on a command line that has a URL; empty when none is.
std::string missing_to_connect(const Options& options);

/// What is missing on a command line of these commands, or too much; empty when nothing is.
std::string missing(const Options& options);

}  // namespace robdef::live
