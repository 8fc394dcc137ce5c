// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/subscription/owner.hpp"

#include <algorithm>
#include <utility>

#include "rr/error.hpp"

namespace rr::subscription {

std::shared_ptr<Services> Owner::add(std::vector<std::vector<std::string>> services,
                                     SubscriptionOptions options) {
  const UrlSource::Lists lists = UrlSource::checked(*host_.core, std::move(services));
  auto subscription = add(std::move(options));
  subscription->urls().replace(lists);
  return subscription;
}

std::shared_ptr<Services> Owner::add(SubscriptionOptions options) {
  auto subscription = std::make_shared<Services>(host_, std::move(options), weak_from_this());
  host_.core->start();
  {
    const MutexLock lock(mutex_);
    if (has_ended_) throw Error(ErrorCode::invalid_operation, "the node is shut down");
    subscriptions_.push_back(subscription);
  }
  return subscription;
}

void Owner::forget(const Services& subscription) {
  std::shared_ptr<Services> gone;
  const MutexLock lock(mutex_);
  const auto found = std::find_if(subscriptions_.begin(), subscriptions_.end(),
                                  [&](const auto& other) { return other.get() == &subscription; });
  if (found == subscriptions_.end()) return;
  gone = std::move(*found);
  subscriptions_.erase(found);
}

void Owner::end() {
  std::vector<std::shared_ptr<Services>> subscriptions;
  {
    const MutexLock lock(mutex_);
    has_ended_ = true;
    subscriptions.swap(subscriptions_);
  }
  for (const auto& subscription : subscriptions) subscription->close();
}

}  // namespace rr::subscription
