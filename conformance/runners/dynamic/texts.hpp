// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

/// The texts of service definitions.
namespace rr::conformance {

/// All of a folder.
std::vector<std::string> read_folder(const std::string& folder);

/// The definition of this name and what it imports, directly or not: what the recorded services
/// know.
std::vector<std::string> with_imports(const std::vector<std::string>& texts,
                                      const std::string& service);

}  // namespace rr::conformance
