// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "rr/stub.hpp"
#include "runtime/c/src/tables.hpp"

/// Ends its function's connection when it is destroyed; then may the tables go.
struct rr_subscription {
  std::shared_ptr<const rr::capi::ClientTables> tables;
  rr::Subscription subscription;
};
