// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "rr/mutex.hpp"
#include "rr/stored.hpp"

namespace rr::service {

/// Who keeps values for one client, and forgets them when it leaves.
class ClientScopedValues {
 public:
  /// False when the client has left.
  bool add(const std::shared_ptr<ClientValues>& values);
  /// The client leaves: all forget what they keep for the session.
  void end(const void* session);

 private:
  Mutex mutex_;
  bool has_ended_ RR_GUARDED_BY(mutex_) = false;
  std::vector<std::weak_ptr<ClientValues>> keepers_ RR_GUARDED_BY(mutex_);
};

}  // namespace rr::service
