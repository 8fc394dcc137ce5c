// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mex.h>

#include <chrono>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace rr::matlab {

/// What takes a field's value. Throws Misfit or rr::Error.
using ReadField = std::function<void(const mxArray* given)>;

/// Reads a struct of options, each field by its function. Throws rr::Error (data_type_mismatch,
/// invalid_argument) that begins with `subject` and names the field.
void read_fields(const mxArray* given, const std::string& subject,
                 const std::map<std::string, ReadField>& known);

// Fields that are just stored. Times are seconds, or fractions of them.
ReadField read_into(std::string& text);
ReadField read_into(bool& flag);
ReadField read_into(std::chrono::milliseconds& time);
ReadField read_into(std::chrono::microseconds& time);  // up to a second
ReadField read_into(std::vector<std::string>& texts);

}  // namespace rr::matlab
