// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/model/model.hpp"

/// Numbers as languages of the family of C write them.
namespace robdef {

/// The literal of an enum's value.
std::string enum_literal(const model::EnumValue& value);
/// A number that fits into `primitive`, as it was written where these languages allow it.
std::string number_literal(const model::Number& value, std::string_view written,
                           model::Primitive primitive);

/// `text` between quotes, with escapes, as C# and JavaScript write it.
std::string unicode_literal(std::string_view text);
/// The same with a literal for each line of the text, and ` +` behind all but the last.
std::vector<std::string> unicode_literal_lines(std::string_view text);

}  // namespace robdef
