// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mex.h>

#include <map>
#include <string>
#include <vector>

#include "rr/varvalue.hpp"

namespace rr::matlab {

/// `containers.Map` or struct of values; `[]` for none. Throws rr::Error.
std::map<std::string, VarValue> read_credentials(const mxArray* given);

/// A text, or a cell array of them. Throws Misfit.
std::vector<std::string> read_texts(const mxArray* given);

}  // namespace rr::matlab
