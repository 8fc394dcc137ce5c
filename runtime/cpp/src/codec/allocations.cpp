// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/codec/allocations.hpp"

#include <cstdlib>
#include <new>

// In a file of its own: where the compiler sees both these and a use of them, it inlines one half
// of a pair and warns of the mismatch.
namespace {

thread_local std::size_t count = 0;

}  // namespace

namespace rr {

std::size_t allocations() { return count; }

}  // namespace rr

void* operator new(std::size_t size) {
  ++count;
  if (void* block = std::malloc(size == 0 ? 1 : size)) return block;
  throw std::bad_alloc();
}
void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }
