// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/stress/watchdog.hpp"

#include <cstdlib>

namespace rr::stress {
namespace {

constexpr std::chrono::seconds period{1};

}  // namespace

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
  while (!ending_.wait_for(lock, period, [&] { return is_ending_; })) look();
}

void Watchdog::look() {
  bool hangs = false;
  for (Watched& one : threads_) {
    const std::uint64_t begun = one.begun;
    const char* const doing = one.doing;
    if (std::exchange(one.seen, begun) != begun) one.unchanged = {};
    one.unchanged += period;
    if (doing == nullptr || one.unchanged < limit_) continue;
    hangs = true;
    lines_.fault(one.name + " hangs in " + doing);
  }
  // With a core, so that a debugger can show where.
  if (hangs) std::abort();
}

}  // namespace rr::stress
