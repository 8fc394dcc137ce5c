// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/stress/watchdog.hpp"

#include <cstdlib>

namespace rr::stress {

Watchdog::Watchdog(Lines& lines, std::chrono::seconds limit)
    : lines_(lines), limit_(limit), thread_([this] { watch(); }) {}

Watchdog::~Watchdog() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  ending_.notify_all();
  thread_.join();
}

Watchdog::Entry::Entry(Watchdog& watchdog, std::string name) : watchdog_(watchdog) {
  const std::lock_guard lock(watchdog.mutex_);
  place_ = watchdog.threads_.emplace(watchdog.threads_.end(), std::move(name));
}

Watchdog::Entry::~Entry() {
  const std::lock_guard lock(watchdog_.mutex_);
  watchdog_.threads_.erase(place_);
}

void Watchdog::watch() {
  std::unique_lock lock(mutex_);
  while (!ending_.wait_for(lock, std::chrono::seconds(1), [&] { return is_ending_; })) look();
}

void Watchdog::look() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  bool hangs = false;
  for (const Watched& one : threads_) {
    const char* const doing = one.doing;
    const auto waited = now - std::chrono::nanoseconds(one.since);
    if (doing == nullptr || waited < limit_) continue;
    hangs = true;
    lines_.fault(one.name + " hangs in " + doing);
  }
  // With a core, so that a debugger can show where.
  if (hangs) std::abort();
}

}  // namespace rr::stress
