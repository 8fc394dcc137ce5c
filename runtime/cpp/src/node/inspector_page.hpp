// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace rr {

/// The page of the inspector that is installed with the runtime: beside the program, or where the
/// build said. Throws rr::Error (invalid_configuration) where it is not.
std::string installed_inspector_page();

}  // namespace rr
