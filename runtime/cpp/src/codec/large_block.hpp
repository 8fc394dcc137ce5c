// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "rr/buffer.hpp"

namespace rr::codec {

/// Memory that comes straight from the system, by whole pages, and goes straight back.
///
/// The heap of the C library would keep it: once a program has freed a large block, blocks of that
/// size come from the heaps of its threads, and what is free at the end of each such heap stays
/// there. What peers made a node hold would stay with it after they have left
/// (docs/reference/limits.md). A few blocks that were given back are spare for the next ones, since
/// fresh pages cost as much as the copy into them.
struct LargeBlock {
  std::byte* bytes = nullptr;
  std::size_t size = 0;
};

/// From this size on blocks are large, in bytes.
inline constexpr std::size_t smallest_large_block = std::size_t{256} * 1024;
/// All spare blocks together, in bytes.
inline constexpr std::size_t most_spare_bytes = std::size_t{13} * 1024 * 1024;

/// At least `size` bytes, aligned to a page. Throws std::bad_alloc. Any thread.
LargeBlock take_large_block(std::size_t size);
/// The same with pages that nobody has touched: each takes memory when it is first written to.
LargeBlock take_fresh_block(std::size_t size);
void give_back_large_block(LargeBlock block) noexcept;
/// Lets go of the blocks that have been spare since this was called before. True when younger ones
/// are left.
bool age_spare_blocks() noexcept;
/// Lets go of all.
void drop_spare_blocks() noexcept;
/// Bytes of all spare blocks.
std::size_t spare_block_bytes() noexcept;
/// As rr::allocate(), but never of a spare block.
Allocation allocate_fresh(std::size_t size);

}  // namespace rr::codec
