// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

namespace rr::conformance {

using Json = nlohmann::json;

}  // namespace rr::conformance
