// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "compiler/backends/cpp/types.hpp"
#include "compiler/model/model.hpp"

/// Constants and literals in C++.
namespace robdef::cpp {

/// `text` between quotes, with escapes.
std::string string_literal(std::string_view text);
/// The type of a constant in C++: `double`, `::std::array<double, 3>`, `::std::string_view`; empty
/// for a struct constant.
std::string constant_type(const model::Constant& constant, Types& types);
/// What stands behind its `=`; empty for a struct constant.
std::string constant_value(const model::Constant& constant);

/// The whole definition of a constant called `name`, in a namespace or, with `storage` "static
/// constexpr", in a class. A struct constant becomes a struct whose members are its values.
std::string constant_definition(const model::Constant& constant, const std::string& name,
                                std::string_view storage, Types& types, std::size_t indent);

}  // namespace robdef::cpp
