// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/memory.hpp"

#include <windows.h>

namespace rr::platform {

std::byte* map_pages(std::size_t size) noexcept {
  return static_cast<std::byte*>(
      VirtualAlloc(nullptr, size, MEM_RESERVE | MEM_COMMIT, PAGE_READWRITE));
}

// A reservation is given back as a whole only; the memory of its pages before that.
void unmap_pages(std::byte* block, std::size_t size, std::size_t kept) noexcept {
  if (kept == 0) {
    VirtualFree(block, 0, MEM_RELEASE);
  } else {
    VirtualFree(block + kept, size - kept, MEM_DECOMMIT);
  }
}

// The heap of Windows gives back by itself.
void fix_heap_thresholds() {}
void trim_heap() {}

}  // namespace rr::platform
