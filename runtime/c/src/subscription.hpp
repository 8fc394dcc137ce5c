// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "rr/stub.hpp"
#include "runtime/c/src/tables.hpp"

/// Disconnects its functions when it is destroyed; after that the tables may be destroyed, too.
struct rr_subscription {
  std::shared_ptr<const rr::capi::ClientTables> tables;
  std::vector<rr::Subscription> subscriptions;
};
