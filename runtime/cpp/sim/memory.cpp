// SPDX-License-Identifier: Apache-2.0
// The program's memory: a run may refuse it to threads of nodes.
#include <cstdlib>
#include <new>

#include "runtime/cpp/sim/faults.hpp"
#include "runtime/cpp/sim/scheduler.hpp"

namespace {

void* allocate(std::size_t size) {
  using rr::sim::Scheduler;
  Scheduler* const run = Scheduler::current();
  if (run != nullptr && rr::sim::Faults::current().refuses_memory(*run, size)) {
    run->note("is refused " + std::to_string(size) + " bytes");
    run->point("is refused memory", nullptr, static_cast<std::int64_t>(size),
               __builtin_return_address(0));
    return nullptr;
  }
  return std::malloc(size == 0 ? 1 : size);
}

}  // namespace

void* operator new(std::size_t size) {
  if (void* const memory = allocate(size)) return memory;
  throw std::bad_alloc();
}

void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
  return allocate(size);
}

void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t /*size*/) noexcept { std::free(memory); }
