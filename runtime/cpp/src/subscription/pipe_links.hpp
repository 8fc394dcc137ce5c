// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <memory>
#include <string>
#include <string_view>

#include "rr/mutex.hpp"
#include "rr/pipes.hpp"
#include "runtime/cpp/src/subscription/links.hpp"

namespace rr::subscription {

/// A pipe at all clients of a subscription.
class PipeLinks final : public Links {
 public:
  struct Packet {
    std::shared_ptr<void> value;
    SubscriptionClientId client;
  };

  /// `max_received` of 0: no limit.
  PipeLinks(std::shared_ptr<endpoint::Core> core, std::weak_ptr<Services> services,
            std::string member, std::string_view path, const Holding& holding,
            std::size_t max_received)
      : Links(std::move(core), std::move(services), std::move(member), path),
        holding_(holding),
        max_received_(max_received) {}

  // See PipeSubscription.
  [[nodiscard]] std::size_t available() const;
  [[nodiscard]] std::size_t lost_count() const;
  void set_backlog_limit(std::size_t packets);
  Packet take();
  bool wait(std::chrono::milliseconds limit);
  Subscription on_received(Function<void(const Packet&)> function);
  std::size_t send_all(const void* value);

 private:
  // An end whose packets are handled without their type.
  class End : public PipeEnd {
   public:
    using PipeEnd::on_received;
    using PipeEnd::PipeEnd;
    using PipeEnd::send;
  };
  struct PipeLink final : Link {
    using Link::Link;
    End end;
  };
  using Receiver = std::shared_ptr<Listener<const Packet&>>;

  static PipeLink& as_pipe(Link& link) { return static_cast<PipeLink&>(link); }
  LinkPointer make_link(std::shared_ptr<const LiveClient> client) override RR_REQUIRES(mutex_);
  void connect(const LinkPointer& link, const std::shared_ptr<Stub>& object) override;
  void use(Link& link) override;
  void leave(Link& link) override;
  void changed() override { arrived_.notify_all(); }
  void end_functions() override RR_REQUIRES(mutex_);

  void put(Packet packet);
  void deliver_soon() RR_REQUIRES(mutex_);
  void deliver();

  const Holding& holding_;
  const std::size_t max_received_;
  mutable Condition arrived_;
  std::deque<Packet> packets_ RR_GUARDED_BY(mutex_);
  std::size_t lost_ RR_GUARDED_BY(mutex_) = 0;
  std::size_t backlog_limit_ RR_GUARDED_BY(mutex_) = 0;
  Receiver receiver_ RR_GUARDED_BY(mutex_);
  bool is_delivering_ RR_GUARDED_BY(mutex_) = false;  // or will be, by the teller
};

}  // namespace rr::subscription
