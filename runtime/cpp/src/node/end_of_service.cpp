// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/node/end_of_service.hpp"

#include "rr/error.hpp"
#include "runtime/cpp/src/node/watchdog.hpp"
#include "runtime/cpp/src/platform/service_manager.hpp"

namespace rr {

int EndOfService::wait(Node& node) {
  bool is_taken = false;
  platform::EndSignals signals(is_taken);
  if (!is_taken) {
    throw Error(ErrorCode::invalid_operation, "the process waits for its end already");
  }
  const Watchdog watchdog(node, platform::watchdog_period());
  set_signals(&signals);
  platform::notify_service_manager("READY=1");
  const int signal = signals.wait();
  platform::notify_service_manager("STOPPING=1");
  set_signals(nullptr);
  return signal;
}

void EndOfService::set_signals(platform::EndSignals* signals) {
  const MutexLock lock(mutex_);
  signals_ = signals;
  if (signals_ != nullptr && is_requested_) signals_->interrupt();
}

void EndOfService::request() {
  const MutexLock lock(mutex_);
  is_requested_ = true;
  if (signals_ != nullptr) signals_->interrupt();
}

}  // namespace rr
