// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "conformance/runners/shared/answer_lines.hpp"
#include "conformance/runners/shared/call.hpp"
#include "conformance/runners/shared/serve.hpp"

namespace rr::conformance {

/// `serve`, `call`, and `both` in one process, where the service is made with one binding and the
/// client with another.
void answer_serve(Binding& binding);
void answer_call(Binding& binding);
void answer_both(Binding& service, Binding& client);

}  // namespace rr::conformance
