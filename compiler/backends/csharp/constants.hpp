// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "compiler/backends/csharp/types.hpp"
#include "compiler/model/model.hpp"

/// Constants and literals in C#.
namespace robdef::csharp {

/// The whole definition of a constant called `name`, in a class. A struct constant becomes a static
/// class whose members are its values; an array a property that gives a span of constant memory.
std::string constant_definition(const model::Constant& constant, const std::string& name,
                                Types& types, Names& names, std::size_t indent);

}  // namespace robdef::csharp
