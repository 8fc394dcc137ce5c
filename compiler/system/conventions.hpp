// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

/// How a system treats text, lists and names.
namespace robdef::system {

/// To be called at the beginning of main(): afterwards the standard streams carry the bytes that
/// are written, and a console shows UTF-8.
void prepare_streams();

/// What separates folders in a list of the environment: each of these letters.
std::string_view list_separators();

/// Why a file cannot have this name in its folder, as "is the name of a device"; empty when it can.
std::string_view fault_of_name(std::string_view name);

/// The same text for paths that are one file: where case does not count, in small letters. Of ASCII
/// alone, as names of definitions are.
std::string one_spelling(std::string path);

}  // namespace robdef::system
