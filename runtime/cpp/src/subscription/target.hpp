// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "rr/call.hpp"
#include "rr/error.hpp"
#include "rr/member_subscription.hpp"
#include "rr/service_filter.hpp"
#include "runtime/cpp/src/channel/interruption.hpp"
#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/client/session.hpp"

namespace rr::subscription {

class Services;

/// A session that a subscription has. Does not change.
struct LiveClient {
  SubscriptionClientId id;
  std::shared_ptr<Session> session;
};

/// Why a session has ended, once it has. Guarded by Services.
struct SessionEnd {
  std::optional<Error> why;
};

/// One attempt to connect to a service.
struct Attempt {
  channel::Interruption interruption;
  std::stop_source cancellation;
  std::atomic<bool> is_over_time{false};

  /// Brings it to its end soon. Not under a lock.
  void give_up() {
    interruption.interrupt();
    cancellation.request_stop();
  }
};

/// A service that a subscription keeps connected. What is not const is guarded by Services.
class Target final : public channel::Timer, public std::enable_shared_from_this<Target> {
 public:
  enum class Phase : std::uint8_t {
    resting,     // until the timer says so
    waiting,     // for its turn, and for another to end where there are as many as may be
    attempting,  // the timer ends it
    connected,
    gone,
  };

  Target(std::weak_ptr<Services> owner, std::shared_ptr<endpoint::Core> core, std::string name,
         FoundService what, bool is_all_known)
      : key(std::move(name)),
        service(std::move(what)),
        is_known(is_all_known),
        services_(std::move(owner)),
        core_(std::move(core)) {}
  ~Target() { core_->reactor().cancel(*this); }

  const std::string key;
  FoundService service;
  bool is_known;           // the attributes and the like
  bool is_fading = false;  // goes when its connection does
  Phase phase = Phase::waiting;
  std::shared_ptr<Attempt> attempt;  // while attempting
  std::shared_ptr<const LiveClient> client;
  std::shared_ptr<const SessionEnd> end;  // of the client
  std::string url;                        // of the client
  std::uint64_t order = 0;                // in which clients were connected
  std::optional<Error> error;             // why it is not connected
  std::uint64_t failed_at = 0;            // in the order of all failures
  std::size_t failures = 0;

 private:
  void on_timer() override;

  const std::weak_ptr<Services> services_;
  const std::shared_ptr<endpoint::Core> core_;
};

}  // namespace rr::subscription
