// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace rr::conformance {

/// Plays the plan of a folder with a runner as client and another as service, and writes what went
/// over the line as `scenarios/<plan>.<version>.json`, and what the client got into the plan
/// itself. For folders of one's own: such a recording holds an implementation to what it did
/// before.
void record(const std::filesystem::path& captures, const std::string& plan,
            const std::string& version, const std::vector<std::string>& runner);

}  // namespace rr::conformance
