// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>

#include "gateway/broker_options.hpp"
#include "gateway/nats_mailbox.hpp"

struct __natsConnection;
struct __natsSubscription;

namespace rr::gateway {

/// One connection to a server of NATS, from its beginning to its end. For one thread.
class NatsLink {
 public:
  /// A subscription, which ends with this.
  class Subscription {
   public:
    /// Of none.
    Subscription() = default;
    /// Takes it over.
    explicit Subscription(__natsSubscription* subscription) : subscription_(subscription) {}

   private:
    struct Ended {
      void operator()(__natsSubscription* subscription) const;
    };
    std::unique_ptr<__natsSubscription, Ended> subscription_;
  };

  /// Connects. All that the link hears goes to `mailbox`. Throws rr::Error (connection_error) that
  /// says why it is not connected.
  NatsLink(const BrokerOptions& broker, const BrokerPlace& place, std::chrono::seconds keep_alive,
           std::shared_ptr<NatsMailbox> mailbox);
  /// Ends it; nothing arrives any more.
  ~NatsLink();
  NatsLink(const NatsLink&) = delete;
  NatsLink& operator=(const NatsLink&) = delete;

  /// From now on messages whose subjects fit arrive.
  Subscription subscribe(const std::string& subject);
  /// False when the connection has failed.
  bool publish(const NatsMessage& message);
  /// The largest message that this server takes, in bytes with its headers.
  [[nodiscard]] std::size_t largest() const;

 private:
  class Callbacks;

  std::unique_ptr<Callbacks> callbacks_;
  __natsConnection* connection_ = nullptr;
};

}  // namespace rr::gateway
