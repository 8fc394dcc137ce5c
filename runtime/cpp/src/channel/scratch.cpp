// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/scratch.hpp"

#include <new>
#include <thread>
#include <utility>

#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/platform/thread_object.hpp"

namespace rr::channel {
namespace {

// What a thread keeps; nested leases make other scratches for as long as they last.
using Spare = std::unique_ptr<Scratch>;

constexpr Milliseconds pause_without_memory{10};

// Nothing can be read without it, so a thread that is refused it waits until there is memory again.
std::unique_ptr<Scratch> make_scratch() {
  while (true) {
    std::unique_ptr<Scratch> scratch(new (std::nothrow) Scratch);  // make_unique would clear it
    if (scratch) return scratch;
    std::this_thread::sleep_for(pause_without_memory);
  }
}

}  // namespace

[[gnu::hot]] ScratchLease::ScratchLease() {
  if (Spare* const spare = platform::thread_object<Spare>()) scratch_ = std::move(*spare);
  if (!scratch_) scratch_ = make_scratch();
}

[[gnu::hot]] ScratchLease::~ScratchLease() {
  scratch_->waiting.clear();
  if (Spare* const spare = platform::thread_object<Spare>()) *spare = std::move(scratch_);
}

[[gnu::hot]] Writer& thread_writer() {
  Writer* const writer = platform::thread_object<Writer>();
  if (writer == nullptr) throw std::bad_alloc();
  return *writer;
}

}  // namespace rr::channel
