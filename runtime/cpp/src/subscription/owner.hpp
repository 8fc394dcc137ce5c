// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "rr/mutex.hpp"
#include "rr/subscription.hpp"
#include "runtime/cpp/src/subscription/host.hpp"
#include "runtime/cpp/src/subscription/services.hpp"

namespace rr::subscription {

/// The subscriptions of a node, which keeps them until they are closed.
class Owner : public std::enable_shared_from_this<Owner> {
 public:
  explicit Owner(Host host) : host_(std::move(host)) {}

  /// A subscription to services by URLs: see Node::subscribe.
  std::shared_ptr<Services> add(std::vector<std::vector<std::string>> services,
                                SubscriptionOptions options);
  /// A subscription whose services somebody else will name, by Services::set_source().
  std::shared_ptr<Services> add(SubscriptionOptions options);
  void forget(const Services& subscription);
  /// Closes all. Does not wait. None can be added any more.
  void end();

 private:
  const Host host_;
  Mutex mutex_;
  bool has_ended_ RR_GUARDED_BY(mutex_) = false;
  std::vector<std::shared_ptr<Services>> subscriptions_ RR_GUARDED_BY(mutex_);
};

}  // namespace rr::subscription
