// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/scratch.hpp"

#include <utility>

namespace rr::channel {
namespace {

// The scratch that a thread keeps; nested leases make others for as long as they last.
thread_local std::unique_ptr<Scratch> unused;  // NOLINT

}  // namespace

[[gnu::hot]] ScratchLease::ScratchLease() {
  scratch_ = std::move(unused);
  if (!scratch_) scratch_.reset(new Scratch);  // not make_unique, which would clear it
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
