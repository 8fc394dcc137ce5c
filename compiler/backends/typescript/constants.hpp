// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "compiler/model/model.hpp"

/// Constants in TypeScript.
namespace robdef::typescript {

/// The value of a constant: `0.5`, `3n`, `[1, 2]`. Of a struct constant an object literal, whose
/// lines but the first begin with `indent` blanks.
std::string constant_value(const model::Constant& constant, std::size_t indent);

/// The same behind `name = `, or `name: readonly number[] = `, for a definition's own constant.
std::string constant_definition(const model::Constant& constant, const std::string& name);

}  // namespace robdef::typescript
