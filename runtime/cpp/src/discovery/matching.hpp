// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "rr/service_filter.hpp"
#include "runtime/cpp/src/discovery/service_watch.hpp"
#include "runtime/cpp/src/subscription/filter.hpp"

namespace rr::discovery {

/// Follows the services that have a type and pass a filter.
class MatchingServices : public ServiceFollower {
 public:
  /// No types: any. Throws rr::Error (invalid_argument) for a wrong filter.
  MatchingServices(std::shared_ptr<endpoint::Core> core, std::vector<std::string> types,
                   ServiceFilter filter);

  void services_are(const DetectedNode& node, const std::vector<FoundService>& services) override;
  void node_lost(const NodeId& node) override;
  /// Others from now on: one at a time with the two above.
  void look_for(std::vector<std::string> types, std::shared_ptr<const subscription::Filter> filter);

 protected:
  /// A service matches now. `key` names it.
  virtual void came(const std::string& key, const FoundService& service) = 0;
  /// It is another, or is reached otherwise.
  virtual void changed(const std::string& key, const FoundService& service) = 0;
  /// It is gone, or does not match any more; or, with `is_silent`, its node has not been heard.
  virtual void went(const std::string& key, const FoundService& service, bool is_silent) = 0;

 private:
  using Services = std::map<std::string, FoundService>;
  [[nodiscard]] bool takes(FoundService& service) const;
  void match(const NodeId& node);

  const std::shared_ptr<endpoint::Core> core_;
  std::vector<std::string> types_;
  std::shared_ptr<const subscription::Filter> filter_;
  std::map<NodeId, std::vector<FoundService>> known_;
  std::map<NodeId, Services> matching_;
};

}  // namespace rr::discovery
