// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "conformance/runners/shared/call.hpp"
#include "conformance/runners/shared/serve.hpp"

namespace rr::conformance {

/// Answers lines of JSON on the standard input with lines of JSON on the standard output, until the
/// input ends. What is thrown is the answer `{"error": text}`.
void answer_lines(const std::function<Json(const Json&)>& answer);

/// `serve`, `call`, and `both` in one process, where the service is made with one binding and the
/// client with another.
void answer_serve(Binding& binding);
void answer_call(Binding& binding);
void answer_both(Binding& service, Binding& client);

}  // namespace rr::conformance
