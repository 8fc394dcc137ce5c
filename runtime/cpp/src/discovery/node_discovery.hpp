// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rr/discovery.hpp"
#include "rr/mutex.hpp"
#include "runtime/cpp/src/discovery/alarm.hpp"
#include "runtime/cpp/src/discovery/announcer.hpp"
#include "runtime/cpp/src/discovery/datagram_receiver.hpp"
#include "runtime/cpp/src/discovery/node_table.hpp"
#include "runtime/cpp/src/discovery/service_watch.hpp"
#include "runtime/cpp/src/subscription/host.hpp"
#include "runtime/cpp/src/subscription/notifier.hpp"

namespace rr::discovery {

/// The discovery of a node: what rr::Discovery is the handle of.
class NodeDiscovery : public std::enable_shared_from_this<NodeDiscovery> {
 public:
  /// `listening` gives where the node listens, as Listener::urls().
  NodeDiscovery(subscription::Host host, std::function<std::vector<std::string>()> listening);

  // See rr::Discovery.
  void announce(AnnounceOptions options);
  void stop_announcing() { announcer_->stop(); }
  void listen(ListenOptions options);
  void stop_listening();
  [[nodiscard]] bool is_listening() const;
  void request();
  [[nodiscard]] std::vector<DetectedNode> detected_nodes() const;
  std::vector<DetectedNode> update_detected_nodes(std::chrono::milliseconds wait);
  Subscription on_detected(Function<void(const DetectedNode&)> function);
  Subscription on_lost(Function<void(const DetectedNode&)> function);
  std::vector<FoundService> find_services(const std::optional<std::string>& type,
                                          const FindOptions& options);
  std::vector<DetectedNode> find_nodes(const FindOptions& options,
                                       const std::function<bool(const DetectedNode&)>& is_wanted);

  /// Listens unless it does.
  void ensure_listening();
  [[nodiscard]] Announcer& announcer() { return *announcer_; }
  [[nodiscard]] const std::shared_ptr<ServiceWatch>& watch_pointer() const { return watch_; }
  /// On a thread that the node's end waits for. Throws rr::Error (invalid_operation) after that.
  void run_aside(std::function<void()> work);
  /// A datagram has come: on a thread of the node. For DatagramReceiver and tests.
  void hear(std::string_view packet, const channel::Address& sender);
  /// Ends everything; waits for nobody.
  void end();

 private:
  /// All that listening needs.
  struct Listening {
    ListenOptions options;
    std::shared_ptr<DatagramReceiver> receiver;
    std::shared_ptr<Alarm> tick;
    std::shared_ptr<Alarm> asking;
    NodeId asker;
    int requests_left = 0;
    channel::Time last_request{};
    NodeTable table;
  };

  void take(const Announcement& announcement, const std::string& sender);
  void tick();
  void send_request();
  void scan_local_nodes();
  void check_open() const RR_REQUIRES(mutex_);
  void notify_lost(const std::vector<KnownNode>& lost);
  void look_first(const FindOptions& options);
  [[nodiscard]] Function<void(const DetectedNode&)> remembering(
      Function<void(const DetectedNode&)> function) const;
  std::shared_ptr<Alarm> alarm(void (NodeDiscovery::*method)());

  const subscription::Host host_;
  const std::shared_ptr<Announcer> announcer_;
  const std::shared_ptr<ServiceWatch> watch_;
  const std::shared_ptr<subscription::Notifier> notifier_;
  Mutex changing_ RR_ACQUIRED_BEFORE(mutex_);  // while listening begins or ends
  mutable Mutex mutex_;
  bool has_ended_ RR_GUARDED_BY(mutex_) = false;
  std::unique_ptr<Listening> listening_ RR_GUARDED_BY(mutex_);
  subscription::Listeners<const DetectedNode&> on_detected_ RR_GUARDED_BY(mutex_);
  subscription::Listeners<const DetectedNode&> on_lost_ RR_GUARDED_BY(mutex_);
  channel::Interruption end_;  // of those who wait
};

}  // namespace rr::discovery
