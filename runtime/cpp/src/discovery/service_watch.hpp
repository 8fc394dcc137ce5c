// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rr/discovery.hpp"
#include "rr/mutex.hpp"
#include "rr/service_filter.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/discovery/alarm.hpp"
#include "runtime/cpp/src/discovery/index_client.hpp"
#include "runtime/cpp/src/discovery/node_table.hpp"
#include "runtime/cpp/src/subscription/host.hpp"
#include "runtime/cpp/src/subscription/notifier.hpp"

namespace rr::discovery {

/// Who follows the services of all nodes. Told one thing at a time, on a thread of the node.
class ServiceFollower {
 public:
  virtual ~ServiceFollower() = default;
  /// All services of a node, as they are from now on.
  virtual void services_are(const DetectedNode& node,
                            const std::vector<FoundService>& services) = 0;
  /// Nothing has been heard of the node for too long.
  virtual void node_lost(const NodeId& node) = 0;
  /// The node is shut down: the last call, on the thread that does it.
  virtual void watch_ended() {}
};

/// Knows the services of the nodes that have announced themselves: asks their service indexes when
/// they come and when they announce a change, while there is a follower or somebody looks (05,
/// section 6.2).
class ServiceWatch : public std::enable_shared_from_this<ServiceWatch> {
 public:
  explicit ServiceWatch(subscription::Host host);

  // From the table of nodes
  void heard(const KnownNode& node);
  void lost(const NodeId& node);
  void end();

  void add(std::shared_ptr<ServiceFollower> follower);
  void remove(const ServiceFollower& follower);
  /// Runs something between what followers are told.
  void run(std::function<void()> work) { notifier_->add(std::move(work)); }
  /// Tells one follower all that is known, once more.
  void repeat(const std::shared_ptr<ServiceFollower>& follower);

  /// Asks all nodes whose services are not known as they are, and waits for the answers until the
  /// deadline; then all services that are known. Throws rr::Error (operation_cancelled).
  std::vector<FoundService> look(channel::Time deadline);

 private:
  enum class Phase : std::uint8_t { idle, waiting, asking };
  struct Row {
    KnownNode known;
    Phase phase = Phase::idle;
    channel::Time due{};
    unsigned failures = 0;
    bool is_fetched = false;
    bool is_outdated = true;
    std::vector<FoundService> services;
    std::deque<std::string> seen_nonces;
    std::deque<channel::Time> refreshes;
    std::shared_ptr<Question> question;  // while asking
  };
  using Followers = std::vector<std::shared_ptr<ServiceFollower>>;

  void plan(Row& row, channel::Time now) RR_REQUIRES(mutex_);
  void plan_all(channel::Time now) RR_REQUIRES(mutex_);
  void set_alarm() RR_REQUIRES(mutex_);
  [[nodiscard]] bool is_busy() const RR_REQUIRES(mutex_);
  [[nodiscard]] std::size_t asked_of_sender(const std::string& sender) const RR_REQUIRES(mutex_);

  void begin_due();
  void ask(const KnownNode& known, const std::shared_ptr<Question>& question);
  void answered(const KnownNode& known, const std::shared_ptr<Question>& question,
                std::optional<std::vector<FoundService>> services);
  void tell(const Followers& followers, const DetectedNode& node,
            const std::vector<FoundService>& services) RR_REQUIRES(mutex_);

  const subscription::Host host_;
  const std::shared_ptr<subscription::Notifier> notifier_;
  Mutex mutex_;
  bool has_ended_ RR_GUARDED_BY(mutex_) = false;
  std::map<NodeId, Row> rows_ RR_GUARDED_BY(mutex_);
  Followers followers_ RR_GUARDED_BY(mutex_);
  std::vector<std::shared_ptr<channel::Interruption>> lookers_
      RR_GUARDED_BY(mutex_);  // each wakes one
  std::shared_ptr<Alarm> alarm_ RR_GUARDED_BY(mutex_);
  std::size_t asking_ RR_GUARDED_BY(mutex_) = 0;
};

}  // namespace rr::discovery
