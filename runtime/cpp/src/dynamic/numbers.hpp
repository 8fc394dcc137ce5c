// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "rr/number.hpp"
#include "rr/type.hpp"

/// What there is of numbers whose type is known at run time (rr/number.hpp).
namespace rr::dynamic {

bool is_complex(ElementType type);
/// Alignment of a number in memory.
std::size_t alignment_of(ElementType type);
/// Describes items of this type; lives for ever.
const ItemType& number_item(ElementType type);
const rr::Type& number_wire_type(ElementType type);

/// Writes the number at `from` as a `to_type` into `to`, if that holds it exactly; a float may
/// round. False, with `to` untouched, otherwise.
bool convert_number(ElementType from_type, const void* from, ElementType to_type, void* to);
/// Shortest decimal; `NaN`, `Infinity`, `-Infinity`; `true`, `false`; `[re, im]`.
std::string number_text(ElementType type, const void* number);

}  // namespace rr::dynamic
