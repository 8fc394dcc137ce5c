// SPDX-License-Identifier: Apache-2.0
#include "compiler/system/conventions.hpp"

namespace robdef::system {

void prepare_streams() {}

std::string_view list_separators() { return ":;"; }

std::string_view fault_of_name(std::string_view /*name*/) { return ""; }

std::string one_spelling(std::string path) { return path; }

}  // namespace robdef::system
