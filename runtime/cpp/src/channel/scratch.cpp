// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/scratch.hpp"

#include <new>
#include <thread>
#include <utility>

#include "runtime/cpp/src/channel/time.hpp"

namespace rr::channel {
namespace {

// The scratch that a thread keeps; nested leases make others for as long as they last.
thread_local std::unique_ptr<Scratch> unused;  // NOLINT

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
  scratch_ = std::move(unused);
  if (!scratch_) scratch_ = make_scratch();
}

[[gnu::hot]] ScratchLease::~ScratchLease() {
  scratch_->waiting.clear();
  unused = std::move(scratch_);
}

[[gnu::hot]] Writer& thread_writer() {
  thread_local Writer writer;
  return writer;
}

}  // namespace rr::channel
