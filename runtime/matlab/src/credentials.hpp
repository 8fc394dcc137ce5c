// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mex.h>

#include <map>
#include <string>
#include <vector>

#include "rr/varvalue.hpp"

namespace rr::matlab {

/// `containers.Map` or struct of values, or a text, which is the password; `[]` for none. Throws
/// rr::Error.
std::map<std::string, VarValue> read_credentials(const mxArray* given);

/// `containers.Map` or struct of values; `[]` for none. Throws rr::Error that begins with
/// `subject`.
std::map<std::string, VarValue> read_varvalues(const mxArray* given, const std::string& subject,
                                               const std::string& expected);

/// A text, or a cell array of them. Throws Misfit.
std::vector<std::string> read_texts(const mxArray* given);

}  // namespace rr::matlab
