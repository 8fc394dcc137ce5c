// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rr/discovery.hpp"
#include "rr/mutex.hpp"
#include "rr/service.hpp"
#include "runtime/cpp/src/channel/channel.hpp"
#include "runtime/cpp/src/endpoint/core.hpp"
#include "runtime/cpp/src/service/logins.hpp"
#include "runtime/cpp/src/service/service_host.hpp"

namespace rr::service {

class ServiceIndex;

/// The services of a node, by name.
class Directory : public std::enable_shared_from_this<Directory> {
 public:
  explicit Directory(std::shared_ptr<endpoint::Core> core);
  /// Discovery: what the index tells of other nodes, and who is told when this node's services are
  /// others, or what is known of them is. Before start().
  struct Discovery {
    std::function<std::vector<DetectedNode>()> detected_nodes{};
    std::function<void()> services_changed{};
  };
  void set_discovery(Discovery discovery) { discovery_ = std::move(discovery); }
  /// Registers the service index, which every node has.
  void start();

  /// Throws rr::Error: invalid_argument for a name that is none, invalid_operation for one in use.
  std::shared_ptr<ServiceHost> add(std::string name, std::shared_ptr<Skeleton> root,
                                   ServiceOptions options);
  void remove(const ServiceHost& host);
  /// Closes all services.
  void close();

  /// Null when there is none.
  [[nodiscard]] std::shared_ptr<ServiceHost> find(std::string_view name) const;
  /// Newest first.
  [[nodiscard]] std::vector<std::shared_ptr<ServiceHost>> all() const;

  [[nodiscard]] std::vector<DetectedNode> detected_nodes() const;
  /// Tells clients of the index, and discovery.
  void services_changed() const;

  /// A receiver for a new incoming connection.
  std::shared_ptr<channel::Receiver> accept(std::shared_ptr<channel::Connection> connection);

  [[nodiscard]] const std::shared_ptr<endpoint::Core>& core() const { return core_; }
  /// Checks who logs in.
  [[nodiscard]] Logins& logins() { return logins_; }

 private:
  const std::shared_ptr<endpoint::Core> core_;
  Logins logins_;
  Discovery discovery_;
  std::shared_ptr<ServiceIndex> index_;  // set by start(), before anybody else uses this
  mutable Mutex mutex_;
  std::vector<std::shared_ptr<ServiceHost>> services_ RR_GUARDED_BY(mutex_);  // oldest first
};

}  // namespace rr::service
