// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <future>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rr/error.hpp"
#include "rr/function.hpp"
#include "rr/node_id.hpp"
#include "rr/service_filter.hpp"
#include "rr/stub.hpp"
#include "rr/visibility.hpp"

/// Finding other nodes and their services, and being found (05).
namespace rr::discovery {
class NodeDiscovery;
class ServiceInfos;
}  // namespace rr::discovery

namespace RR_VISIBLE rr {

/// Where the packets of discovery go and are listened to (05, section 1).
struct DiscoveryNetwork {
  bool node_local = false;  ///< `ff01::ba86`
  bool link_local = true;   ///< `ff02::ba86`
  bool site_local = false;  ///< `ff05::ba86`
  /// 255.255.255.255. A node that listens hears IPv4 in any case, but asks there only with this.
  bool ipv4_broadcast = false;
  /// Names of the interfaces to send from; empty: all that are up.
  std::vector<std::string> interfaces{};
  /// Nodes with another port than the usual one find each other only.
  std::uint16_t port = 48653;
};

/// How a node makes itself known.
struct AnnounceOptions {
  DiscoveryNetwork network{};  ///< where announcements go
  /// From one announcement to the next; 500 ms at least.
  std::chrono::milliseconds period{55'000};
};

/// How a node listens to others.
struct ListenOptions {
  /// Where announcements are listened to.
  DiscoveryNetwork network{};
  /// A way to reach a node is forgotten so long after its last announcement, and the node with the
  /// last of them.
  std::chrono::milliseconds lifetime{60'000};
  /// Nodes that are kept; further ones are not heeded until others have gone.
  std::size_t max_nodes = 4096;
  /// Of these, nodes that one sender's address has announced first.
  std::size_t max_nodes_of_sender = 256;
  /// Whether nodes of this machine are looked for in the files of local sockets, too (05, section
  /// 5).
  bool local = true;
};

/// A node that has announced itself. Nothing of this is proven: whether it is the node that it says
/// it is shows in connecting.
struct DetectedNode {
  NodeId id{};                      ///< as it says
  std::string name{};               ///< empty for none
  std::vector<std::string> urls{};  ///< of its service index; with find_node(): of the node
};

/// How to look for nodes and services.
struct FindOptions {
  /// `rr+tcp`, ...: other ways to reach a node are left out, and nodes without any. Empty: all.
  std::vector<std::string> schemes{};
  /// Nodes are asked to announce themselves, and waited for so long, before the answer is made.
  /// 0: what is known already will do.
  std::chrono::milliseconds wait{0};
  /// How long service indexes are waited for, all together. What has not answered is left out.
  std::chrono::milliseconds timeout{5'000};
};

/// What a node knows of others, and what it tells them. Made by Node::discovery(); copies are
/// handles of the same. Nothing happens, and no thread or socket exists, until something is asked
/// for. Any thread may use it; nothing blocks but the forms that are said to.
///
///   rr::Discovery discovery = node.discovery();
///   discovery.listen();
///   for (const rr::FoundService& arm : discovery.find_services("my.Arm", {.wait = 1s}))
///     show(arm.name, arm.urls);
class Discovery {
 public:
  /// A handle of nothing.
  Discovery() = default;

  /// Announces this node from now on, at all addresses it listens at, now and later, by TCP: every
  /// period, and when its services change. While it listens as well it answers requests. Replaces
  /// earlier options. Throws rr::Error (invalid_operation) after the node's shutdown().
  void announce(AnnounceOptions options = {}) const;
  /// Ends announcing. Nodes that know this one forget it when its last announcement has run out.
  void stop_announcing() const;
  /// Listens to announcements and requests from now on, and asks all nodes for theirs. Replaces
  /// earlier options, and then forgets what was heard. Throws rr::Error: connection_error when the
  /// port cannot be used, invalid_operation after the node's shutdown().
  void listen(ListenOptions options = {}) const;
  /// Also forgets all nodes.
  void stop_listening() const;
  /// Whether it listens. False after the node's shutdown().
  [[nodiscard]] bool is_listening() const;
  /// Asks all nodes to announce themselves: three packets within three seconds. Needs listen().
  void request() const;

  /// All nodes that are known now.
  [[nodiscard]] std::vector<DetectedNode> detected_nodes() const;
  /// The same after asking all nodes, and waiting so long. Blocks.
  [[nodiscard]] std::vector<DetectedNode> update_detected_nodes(
      std::chrono::milliseconds wait) const;
  /// Calls `function` for nodes that are known, and for each one that is found later; when all ways
  /// to reach one are forgotten it is lost. These run one at a time, in order, on a thread of the
  /// node, and may use everything.
  Subscription on_detected(Function<void(const DetectedNode&)> function) const;
  /// Calls `function` for each node that is lost, as on_detected().
  Subscription on_lost(Function<void(const DetectedNode&)> function) const;

  // The following block. They listen with default options if nothing was said, and throw rr::Error:
  // operation_cancelled when interrupted, invalid_operation after the node's shutdown().
  /// All services whose root object has this type, or implements it; each with all URLs that it may
  /// be reached by. Asks the service indexes of all nodes whose services are not known.
  [[nodiscard]] std::vector<FoundService> find_services(std::string_view type,
                                                        const FindOptions& options = {}) const;
  /// All services of all nodes, the indexes themselves included.
  [[nodiscard]] std::vector<FoundService> all_services(const FindOptions& options = {}) const;
  /// The node of this id, or all nodes of this name; `urls` name no service then.
  [[nodiscard]] std::vector<DetectedNode> find_node(const NodeId& id,
                                                    const FindOptions& options = {}) const;
  /// All nodes of this name.
  [[nodiscard]] std::vector<DetectedNode> find_nodes(std::string_view name,
                                                     const FindOptions& options = {}) const;

  /// As find_services(), on a thread of its own, which the node's end waits for.
  [[nodiscard]] std::future<std::vector<FoundService>> async_find_services(
      std::string type, FindOptions options = {}) const;
  /// As find_node(), on a thread of its own, which the node's end waits for.
  [[nodiscard]] std::future<std::vector<DetectedNode>> async_find_node(
      const NodeId& id, FindOptions options = {}) const;
  /// As find_nodes(), on a thread of its own, which the node's end waits for.
  [[nodiscard]] std::future<std::vector<DetectedNode>> async_find_nodes(
      std::string name, FindOptions options = {}) const;
  /// As update_detected_nodes(), on a thread of its own, which the node's end waits for.
  [[nodiscard]] std::future<std::vector<DetectedNode>> async_update_detected_nodes(
      std::chrono::milliseconds wait) const;
  /// Calls `done` there.
  void find_services_aside(
      std::string type, FindOptions options,
      Function<void(std::exception_ptr, std::vector<FoundService>)> done) const;

  /// For the runtime: Node::discovery() makes it.
  explicit Discovery(std::shared_ptr<discovery::NodeDiscovery> state);  // by Node

 private:
  std::shared_ptr<discovery::NodeDiscovery> state_;
};

/// Services that match, without connections to them: made by Node::subscribe_services. Copies are
/// handles of the same, which lasts until it is closed or its node is shut down.
class ServiceInfoSubscription {
 public:
  /// A handle of nothing.
  ServiceInfoSubscription() = default;

  /// Ends the subscription: its functions are not called any more. Does not wait.
  void close() const;
  /// False once it is closed or its node is shut down.
  [[nodiscard]] bool is_open() const;
  /// Those that are there now.
  [[nodiscard]] std::vector<FoundService> services() const;
  /// Calls `function` for each that is there, and each that is found later. These run one at a
  /// time, in order, on a thread of the node.
  Subscription on_detected(Function<void(const FoundService&)> function) const;
  /// The same for services whose attributes or URLs are others now.
  Subscription on_changed(Function<void(const FoundService&)> function) const;
  /// The same for services that are not there any more.
  Subscription on_lost(Function<void(const FoundService&)> function) const;

  /// For the runtime: Node::subscribe_services() makes it.
  explicit ServiceInfoSubscription(std::shared_ptr<discovery::ServiceInfos> state);  // by Node

 private:
  std::shared_ptr<discovery::ServiceInfos> state_;
};

}  // namespace rr
