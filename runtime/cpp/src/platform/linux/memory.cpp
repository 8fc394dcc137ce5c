// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/memory.hpp"

#include <malloc.h>
#include <sys/mman.h>

#include <cstdlib>
#include <initializer_list>

namespace rr::platform {

std::byte* map_pages(std::size_t size) noexcept {
  void* const bytes =
      ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  return bytes == MAP_FAILED ? nullptr : static_cast<std::byte*>(bytes);
}

void unmap_pages(std::byte* block, std::size_t size, std::size_t kept) noexcept {
  ::munmap(block + kept, size - kept);
}

// Other C libraries than glibc have neither.
#if defined(__GLIBC__)

// glibc raises both thresholds when a program frees a large block. Each heap may then keep tens of
// megabytes at its end, where malloc_trim() looks in the main one only.
void fix_heap_thresholds() {
  constexpr int mmap_threshold = 1024 * 1024;
  constexpr int trim_threshold = 128 * 1024;  // as it is at first
  static const bool is_set_outside = [] {
    for (const char* name :
         {"GLIBC_TUNABLES", "MALLOC_TRIM_THRESHOLD_", "MALLOC_MMAP_THRESHOLD_"}) {
      if (std::getenv(name) != nullptr) return true;
    }
    mallopt(M_MMAP_THRESHOLD, mmap_threshold);
    mallopt(M_TRIM_THRESHOLD, trim_threshold);
    return false;
  }();
  static_cast<void>(is_set_outside);
}

void trim_heap() { malloc_trim(0); }

#else

void fix_heap_thresholds() {}
void trim_heap() {}

#endif

}  // namespace rr::platform
