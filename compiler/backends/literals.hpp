// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "compiler/model/model.hpp"

/// Numbers as languages of the family of C write them.
namespace robdef {

/// The literal of an enum's value.
std::string enum_literal(const model::EnumValue& value);
/// A number that fits into `primitive`, as it was written where these languages allow it.
std::string number_literal(const model::Number& value, std::string_view written,
                           model::Primitive primitive);

}  // namespace robdef
