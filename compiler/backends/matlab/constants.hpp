// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "compiler/model/model.hpp"

/// Values as MATLAB and Octave both read them.
namespace robdef::matlab {

/// `'It''s'`; what is no printable character stands as its number: `['two' char(10) 'lines']`.
std::string string_literal(std::string_view text);
/// The value of a constant: `int16(-100)`, `[0.25; -0.5]`, `struct('trim', int16(-100))`.
std::string constant_value(const model::Constant& constant);

}  // namespace robdef::matlab
