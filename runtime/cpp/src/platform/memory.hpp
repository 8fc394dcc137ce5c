// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace rr::platform {

/// What map_pages() gives is a multiple of this, in bytes.
inline constexpr std::size_t page_size = 4096;

/// Fresh pages from the system, filled with zeros. `size` in bytes, whole pages. Null when there
/// are none.
std::byte* map_pages(std::size_t size) noexcept;
/// Gives back the end of a block of map_pages() that has `size` bytes by now: all but its first
/// `kept` bytes, which are whole pages. With 0 the block is gone.
void unmap_pages(std::byte* block, std::size_t size, std::size_t kept) noexcept;

/// Makes the heap of the C library keep less of what was freed, where it can be told so and nobody
/// has done so from outside. Once for a process.
void fix_heap_thresholds();
/// Gives back what is free in the heap of the C library, where that keeps it. Takes milliseconds.
void trim_heap();

}  // namespace rr::platform
