// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/subscription/notifier.hpp"

#include <utility>

#include "runtime/cpp/src/endpoint/user_code.hpp"

namespace rr::subscription {

void Notifier::add(std::function<void()> work) {
  const MutexLock lock(mutex_);
  work_.push_back(std::move(work));
  if (std::exchange(is_running_, true)) return;
  core_->reactor().post([self = shared_from_this()] { self->run(); });
}

void Notifier::run() {
  while (true) {
    std::function<void()> work;
    {
      const MutexLock lock(mutex_);
      if (work_.empty()) {
        is_running_ = false;
        return;
      }
      work = std::move(work_.front());
      work_.pop_front();
    }
    endpoint::call_user_code(*core_, "a function for a subscription", work);
  }
}

}  // namespace rr::subscription
