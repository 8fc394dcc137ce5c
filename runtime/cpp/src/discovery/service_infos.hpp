// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "rr/discovery.hpp"
#include "rr/mutex.hpp"
#include "runtime/cpp/src/discovery/matching.hpp"
#include "runtime/cpp/src/subscription/notifier.hpp"

namespace rr::discovery {

/// What rr::ServiceInfoSubscription is the handle of.
class ServiceInfos final : public MatchingServices {
 public:
  ServiceInfos(std::shared_ptr<ServiceWatch> watch, std::shared_ptr<endpoint::Core> core,
               std::vector<std::string> types, ServiceFilter filter);

  void close();
  [[nodiscard]] bool is_open() const;
  [[nodiscard]] std::vector<FoundService> services() const;
  Subscription on_detected(Function<void(const FoundService&)> function);
  Subscription on_changed(Function<void(const FoundService&)> function);
  Subscription on_lost(Function<void(const FoundService&)> function);

 private:
  void came(const std::string& key, const FoundService& service) override;
  void changed(const std::string& key, const FoundService& service) override;
  void went(const std::string& key, const FoundService& service, bool is_silent) override;
  void watch_ended() override { close(); }
  void check_open() const RR_REQUIRES(mutex_);

  const std::shared_ptr<ServiceWatch> watch_;
  const std::shared_ptr<subscription::Notifier> notifier_;
  mutable Mutex mutex_;
  bool is_closed_ RR_GUARDED_BY(mutex_) = false;
  std::map<std::string, FoundService> notified_ RR_GUARDED_BY(mutex_);  // listeners know these
  subscription::Listeners<const FoundService&> on_detected_ RR_GUARDED_BY(mutex_);
  subscription::Listeners<const FoundService&> on_changed_ RR_GUARDED_BY(mutex_);
  subscription::Listeners<const FoundService&> on_lost_ RR_GUARDED_BY(mutex_);
};

}  // namespace rr::discovery
