// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "runtime/cpp/src/dynamic/content.hpp"
#include "runtime/cpp/src/dynamic/nodes.hpp"

/// Parts of memories as values, and as they lie in memory.
namespace rr::dynamic {

/// An array of a memory's type with room for `size` items, the product of the counts, which are
/// none above any_length.
std::shared_ptr<ArrayContent> new_array(const ArrayNode& type, std::span<const std::uint64_t> count,
                                        std::size_t size);

}  // namespace rr::dynamic
