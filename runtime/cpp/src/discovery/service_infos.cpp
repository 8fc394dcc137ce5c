// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/discovery/service_infos.hpp"

#include <utility>

#include "rr/error.hpp"

namespace rr::discovery {

ServiceInfos::ServiceInfos(std::shared_ptr<ServiceWatch> watch,
                           std::shared_ptr<endpoint::Core> core, std::vector<std::string> types,
                           ServiceFilter filter)
    : MatchingServices(core, std::move(types), std::move(filter)),
      watch_(std::move(watch)),
      notifier_(std::make_shared<subscription::Notifier>(core)) {}

void ServiceInfos::check_open() const {
  if (is_closed_) throw Error(ErrorCode::invalid_operation, "the subscription is closed");
}

void ServiceInfos::close() {
  {
    const MutexLock lock(mutex_);
    if (std::exchange(is_closed_, true)) return;
    notified_.clear();
    on_detected_.end(*notifier_);
    on_changed_.end(*notifier_);
    on_lost_.end(*notifier_);
  }
  watch_->remove(*this);
}

bool ServiceInfos::is_open() const {
  const MutexLock lock(mutex_);
  return !is_closed_;
}

std::vector<FoundService> ServiceInfos::services() const {
  std::vector<FoundService> result;
  const MutexLock lock(mutex_);
  for (const auto& [key, service] : notified_) result.push_back(service);
  return result;
}

Subscription ServiceInfos::on_detected(Function<void(const FoundService&)> function) {
  const MutexLock lock(mutex_);
  check_open();
  const auto listener = on_detected_.add(std::move(function));
  for (const auto& [key, service] : notified_) {
    notifier_->add([listener, told = service] { listener->call(told); });
  }
  return Subscription(listener);
}

Subscription ServiceInfos::on_changed(Function<void(const FoundService&)> function) {
  const MutexLock lock(mutex_);
  check_open();
  return Subscription(on_changed_.add(std::move(function)));
}

Subscription ServiceInfos::on_lost(Function<void(const FoundService&)> function) {
  const MutexLock lock(mutex_);
  check_open();
  return Subscription(on_lost_.add(std::move(function)));
}

void ServiceInfos::came(const std::string& key, const FoundService& service) {
  const MutexLock lock(mutex_);
  if (is_closed_) return;
  notified_[key] = service;
  on_detected_.notify(*notifier_, service);
}

void ServiceInfos::changed(const std::string& key, const FoundService& service) {
  const MutexLock lock(mutex_);
  if (is_closed_) return;
  notified_[key] = service;
  on_changed_.notify(*notifier_, service);
}

void ServiceInfos::went(const std::string& key, const FoundService& service, bool /*is_silent*/) {
  const MutexLock lock(mutex_);
  if (notified_.erase(key) != 0) on_lost_.notify(*notifier_, service);
}

}  // namespace rr::discovery
