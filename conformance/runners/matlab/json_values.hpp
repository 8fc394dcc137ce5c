// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mex.h>

#include "conformance/harness/json.hpp"

/// JSON in the interpreter, nothing lost: an object is a struct, a list a column of cells, null
/// `[]`, a number a double.
namespace rr::conformance {

mxArray* json_to_mex(const Json& json);
/// Throws Misfit for what is no such value.
Json json_from_mex(const mxArray* value);

}  // namespace rr::conformance
