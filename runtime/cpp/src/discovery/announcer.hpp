// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rr/discovery.hpp"
#include "rr/mutex.hpp"
#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/discovery/alarm.hpp"
#include "runtime/cpp/src/discovery/interfaces.hpp"

namespace rr::discovery {

/// Announces a node: every period, and soon after something has changed or somebody has asked (05,
/// section 3).
class Announcer : public std::enable_shared_from_this<Announcer> {
 public:
  /// `listening` gives where the node listens, as Listener::urls().
  Announcer(std::shared_ptr<channel::Reactor> reactor, NodeId id, std::string name,
            std::function<std::vector<std::string>()> listening);

  void start(AnnounceOptions options);
  void stop();
  /// Half a second from now, together with what is asked for until then, and at most once a second.
  void announce_soon();
  /// The node's services are others: a new nonce, and the same.
  void services_changed();
  /// What tells the state of the node's services.
  [[nodiscard]] std::string nonce() const;

 private:
  void announce();
  [[nodiscard]] std::vector<std::string> packets_for(const LocalAddress& from) const;

  const std::shared_ptr<channel::Reactor> reactor_;
  const NodeId id_;
  const std::string name_;
  const std::function<std::vector<std::string>()> listening_;
  mutable Mutex mutex_;
  std::optional<AnnounceOptions> options_ RR_GUARDED_BY(mutex_);  // nothing: nobody is told
  std::string nonce_ RR_GUARDED_BY(mutex_);
  std::shared_ptr<Alarm> alarm_ RR_GUARDED_BY(mutex_);
  channel::Time due_ RR_GUARDED_BY(mutex_) = channel::never;
  channel::Time last_ RR_GUARDED_BY(mutex_) = channel::Time::min();
};

}  // namespace rr::discovery
