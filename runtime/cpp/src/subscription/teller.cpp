// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/subscription/teller.hpp"

#include <exception>
#include <string>

namespace rr::subscription {

void Teller::add(std::function<void()> work) {
  const std::lock_guard lock(mutex_);
  work_.push_back(std::move(work));
  if (std::exchange(is_running_, true)) return;
  core_->reactor().post([self = shared_from_this()] { self->run(); });
}

void Teller::run() {
  while (true) {
    std::function<void()> work;
    {
      const std::lock_guard lock(mutex_);
      if (work_.empty()) {
        is_running_ = false;
        return;
      }
      work = std::move(work_.front());
      work_.pop_front();
    }
    try {
      work();
    } catch (const std::exception& error) {
      core_->log(LogLevel::error,
                 std::string("a function for a subscription has thrown: ") + error.what());
    } catch (...) {
      core_->log(LogLevel::error, "a function for a subscription has thrown");
    }
  }
}

}  // namespace rr::subscription
