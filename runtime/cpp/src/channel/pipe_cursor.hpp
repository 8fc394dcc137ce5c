// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "rr/mutex.hpp"
#include "runtime/cpp/src/channel/pipe_ring_steps.hpp"
#include "runtime/cpp/src/channel/slot_holds.hpp"

namespace rr::channel {

/// The words by which the reader of a pipe's ring says how far it is, as its client has them. Any
/// thread.
class PipeCursor final : public HeldPlace {
 public:
  using Steps = PipeRingSteps<Synchronization>;
  using Words = HoldWords<Synchronization>;

  explicit PipeCursor(std::shared_ptr<Words> words) : words_(std::move(words)) {}

  /// Before anything else: `turn` is what the service has said.
  void begin(std::uint64_t turn, std::uint64_t position);
  /// All before this position was copied.
  void advance(std::uint64_t position);
  /// Requests a notice of the next packet behind this position. False when there is already.
  [[nodiscard]] bool ask(const Steps::Words& ring, const Steps::Until& until,
                         std::uint64_t position);
  void detach() override;

 private:
  Mutex mutex_;
  std::shared_ptr<Words> words_ RR_GUARDED_BY(mutex_);  // null: detached
  std::uint64_t asked_ RR_GUARDED_BY(mutex_) = 0;
};

}  // namespace rr::channel
