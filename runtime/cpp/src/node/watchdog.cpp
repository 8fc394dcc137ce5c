// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/node/watchdog.hpp"

#include <memory>

#include "rr/error.hpp"
#include "runtime/cpp/src/platform/service_manager.hpp"
#include "runtime/cpp/src/platform/threads.hpp"

namespace rr {
namespace {

// Outlives a round whose timer comes late.
struct Sign {
  Mutex mutex;
  Condition condition;
  bool has_come RR_GUARDED_BY(mutex) = false;
};

}  // namespace

Watchdog::Watchdog(Node& node, std::chrono::microseconds period) : node_(node), pause_(period / 2) {
  if (pause_ > std::chrono::microseconds(0)) thread_ = std::thread([this] { run(); });
}

Watchdog::~Watchdog() {
  if (!thread_.joinable()) return;
  {
    const MutexLock lock(mutex_);
    is_over_ = true;
  }
  over_.notify_all();
  thread_.join();
}

void Watchdog::run() {
  platform::leave_signals_to_others();
  auto due = std::chrono::steady_clock::now();
  while (true) {
    if (turns()) platform::notify_service_manager("WATCHDOG=1");
    due += pause_;
    const MutexLock lock(mutex_);
    while (!is_over_ && std::chrono::steady_clock::now() < due) over_.wait_until(mutex_, due);
    if (is_over_) return;
  }
}

// Whether the node runs a timer before the next round.
bool Watchdog::turns() {
  const auto sign = std::make_shared<Sign>();
  const auto deadline = std::chrono::steady_clock::now() + pause_ / 2;
  try {
    const Timer timer = node_.after(std::chrono::nanoseconds(0), [sign] {
      const MutexLock lock(sign->mutex);
      sign->has_come = true;
      sign->condition.notify_all();
    });
    const MutexLock lock(sign->mutex);
    while (!sign->has_come && std::chrono::steady_clock::now() < deadline) {
      sign->condition.wait_until(sign->mutex, deadline);
    }
    return sign->has_come;
  } catch (const Error&) {
    return false;  // the node has been shut down
  }
}

}  // namespace rr
