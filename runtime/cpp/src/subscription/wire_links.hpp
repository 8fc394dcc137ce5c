// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "rr/mutex.hpp"
#include "rr/wires.hpp"
#include "runtime/cpp/src/endpoint/newest_value.hpp"
#include "runtime/cpp/src/subscription/links.hpp"

namespace rr::subscription {

/// A wire at all clients of a subscription.
class WireLinks final : public Links {
 public:
  struct Value {
    std::shared_ptr<const void> value;
    TimeSpec time;
    SubscriptionClientId client;
  };

  WireLinks(std::shared_ptr<endpoint::Core> core, std::weak_ptr<Services> services,
            std::string member, std::string_view path, const Holding& holding)
      : Links(std::move(core), std::move(services), std::move(member), path), holding_(holding) {}

  [[nodiscard]] const Holding& holding() const { return holding_; }

  // See WireSubscription.
  void set_lifespan(std::chrono::milliseconds lifespan);
  [[nodiscard]] Value received() const;
  [[nodiscard]] std::vector<Value> all_received() const;
  bool wait(std::chrono::milliseconds limit);
  Subscription on_received(Function<void(const Value&)> function);
  std::size_t send_all(const void* value);

 private:
  // An end whose values are handled without their type.
  class End : public WireEnd {
   public:
    using WireEnd::on_received;
    using WireEnd::received;
    using WireEnd::send;
    using WireEnd::WireEnd;
    void on_refused(std::function<void(const Error&)> function);
  };
  struct WireLink final : Link {
    using Link::Link;
    End end;
    endpoint::NewestValue newest;
    std::uint64_t sequence = 0;  // of the newest value
  };
  // A function, and the last value that it was called with or has missed.
  struct Notified {
    std::shared_ptr<Listener<const Value&>> listener;
    std::uint64_t seen = 0;
  };
  struct Turn {
    std::shared_ptr<Listener<const Value&>> listener;
    Value value;
  };

  static WireLink& as_wire(Link& link) { return static_cast<WireLink&>(link); }
  LinkPointer make_link(std::shared_ptr<const LiveClient> client) override RR_REQUIRES(mutex_);
  void connect(const LinkPointer& link, const std::shared_ptr<Stub>& object) override;
  void use(Link& link) override;
  void leave(Link& link) override;
  void changed() override { arrived_.notify_all(); }
  void end_functions() override RR_REQUIRES(mutex_);

  void forget(WireLink& link);
  void take(WireLink& link);
  void notify_soon() RR_REQUIRES(mutex_);
  void notify_all();
  std::vector<Turn> next_turn();
  [[nodiscard]] std::vector<const WireLink*> fresh_links() const RR_REQUIRES(mutex_);

  const Holding& holding_;
  Condition arrived_;
  endpoint::NewestValue newest_ RR_GUARDED_BY(mutex_);
  SubscriptionClientId newest_client_ RR_GUARDED_BY(mutex_);
  std::uint64_t sequence_ RR_GUARDED_BY(mutex_) = 0;  // counts values
  std::chrono::milliseconds lifespan_ RR_GUARDED_BY(mutex_){0};
  std::vector<Notified> notified_ RR_GUARDED_BY(mutex_);
  bool is_notifying_ RR_GUARDED_BY(mutex_) = false;  // or will be, by the notifier
};

}  // namespace rr::subscription
