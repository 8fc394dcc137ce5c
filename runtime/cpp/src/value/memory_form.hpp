// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "rr/array_type.hpp"

/// What is to be known of a memory's type to transfer parts of it (07, section 13).
namespace rr::value {

struct MemoryForm {
  bool is_multi;  ///< positions are arrays, the data is a MultiArray
  const ItemType* item;
};
/// `type` is that of a member: an ArrayType or a MultiArrayType.
MemoryForm memory_form(const Type& type);

/// Bytes that an item counts for against the limit of a transfer. A pod: the most that it takes in
/// format 2. A namedarray: one of its numbers, as existing implementations count.
std::size_t transfer_size(const ItemType& item);

}  // namespace rr::value
