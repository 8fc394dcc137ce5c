// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "conformance/harness/json.hpp"

namespace rr::conformance {

/// Answers lines of JSON on the standard input with lines of JSON on the standard output, until the
/// input ends. What is thrown is the answer `{"error": text}`.
void answer_lines(const std::function<Json(const Json&)>& answer);

}  // namespace rr::conformance
