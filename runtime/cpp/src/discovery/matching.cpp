// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/discovery/matching.hpp"

#include <algorithm>
#include <utility>

namespace rr::discovery {

MatchingServices::MatchingServices(std::shared_ptr<endpoint::Core> core,
                                   std::vector<std::string> types, ServiceFilter filter)
    : core_(std::move(core)),
      types_(std::move(types)),
      filter_(std::make_shared<const subscription::Filter>(std::move(filter))) {}

// Leaves the URLs that the filter takes.
bool MatchingServices::takes(FoundService& service) const {
  const auto is_wanted = [&](const std::string& type) {
    return std::find(types_.begin(), types_.end(), type) != types_.end();
  };
  const auto& others = service.implements;
  if (!types_.empty() && !is_wanted(service.object_type) &&
      std::none_of(others.begin(), others.end(), is_wanted)) {
    return false;
  }
  if (!filter_->choose_node(service.node, service.node_name, true).is_wanted ||
      !filter_->takes_name(service.name)) {
    return false;
  }
  std::erase_if(service.urls, [&](const std::string& url) { return !filter_->takes_scheme(url); });
  if (service.urls.empty()) return false;
  try {
    return filter_->refusal(service).empty();
  } catch (const std::exception& error) {
    core_->log(LogLevel::warning, std::string("a predicate has thrown: ") + error.what());
  } catch (...) {
    core_->log(LogLevel::warning, "a predicate has thrown");
  }
  return false;
}

void MatchingServices::match(const NodeId& node) {
  Services now;
  if (const auto known = known_.find(node); known != known_.end()) {
    for (FoundService service : known->second) {
      if (takes(service)) now.emplace(node.text() + " " + service.name, std::move(service));
    }
  }
  const Services before = std::exchange(matching_[node], now);
  if (now.empty()) matching_.erase(node);
  for (const auto& [key, service] : before) {
    if (!now.contains(key)) went(key, service, false);
  }
  for (const auto& [key, service] : now) {
    const auto old = before.find(key);
    if (old == before.end()) {
      came(key, service);
    } else if (!(old->second == service)) {
      changed(key, service);
    }
  }
}

void MatchingServices::services_are(const DetectedNode& node,
                                    const std::vector<FoundService>& services) {
  // Predicates and functions of the program get them.
  for (const FoundService& service : services) core_->found_urls().add(service.urls);
  known_[node.id] = services;
  match(node.id);
}

void MatchingServices::node_lost(const NodeId& node) {
  known_.erase(node);
  const auto found = matching_.find(node);
  if (found == matching_.end()) return;
  const Services before = std::move(found->second);
  matching_.erase(found);
  for (const auto& [key, service] : before) went(key, service, true);
}

void MatchingServices::look_for(std::vector<std::string> types,
                                std::shared_ptr<const subscription::Filter> filter) {
  types_ = std::move(types);
  filter_ = std::move(filter);
  std::vector<NodeId> nodes;
  for (const auto& [node, services] : known_) nodes.push_back(node);
  for (const NodeId& node : nodes) match(node);
}

}  // namespace rr::discovery
