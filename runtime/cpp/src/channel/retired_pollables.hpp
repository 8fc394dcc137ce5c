// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

namespace rr::channel {

class Pollable;

/// Keeps what the reactor does not watch any more until nobody can name it: events that were
/// fetched already may, and threads that are still in its handler, or about to enter that. No lock
/// of itself: that of the reactor guards it.
class RetiredPollables {
 public:
  using Pollables = std::vector<std::shared_ptr<Pollable>>;

  /// False once end() was called: the pollable stays the caller's, who releases it without a lock.
  bool add(std::shared_ptr<Pollable>&& pollable);
  /// A thread that does not poll any more is in the handler of `pollable`, until leave().
  void enter(const Pollable* pollable) { inside_.push_back(pollable); }
  void leave(const Pollable* pollable);
  [[nodiscard]] bool empty() const { return retired_.empty(); }
  /// Those that no thread is in: for when no event can name them. The caller destroys them without
  /// a lock.
  [[nodiscard]] Pollables take();
  /// No thread is left: nothing is kept from now on. Returns what was.
  [[nodiscard]] Pollables end();

 private:
  bool has_ended_ = false;
  Pollables retired_;
  std::vector<const Pollable*> inside_;  // once for each thread
};

}  // namespace rr::channel
