// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/cpp/src/channel/connection.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/service/server_endpoint.hpp"

namespace rr::service {

/// While a member waits, its client's next requests are handled: what it waits for may depend on
/// one of them. When they are still at it at the deadline the member goes on beside them.
class TurnBreak {
 public:
  explicit TurnBreak(channel::Time deadline) : deadline_(deadline) {
    ServerEndpoint* const endpoint = ServerEndpoint::current();
    if (endpoint != nullptr && endpoint->connection().step_out()) {
      connection_ = &endpoint->connection();
    }
  }
  ~TurnBreak() {
    if (connection_ != nullptr) connection_->step_in(deadline_);
  }
  TurnBreak(const TurnBreak&) = delete;
  TurnBreak& operator=(const TurnBreak&) = delete;

 private:
  const channel::Time deadline_;
  channel::Connection* connection_ = nullptr;
};

}  // namespace rr::service
