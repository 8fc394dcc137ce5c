// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "runtime/c/test/handles.hpp"
#include "runtime/cpp/src/discovery/testing.hpp"
#include "runtime/cpp/src/node/testing/counter.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::testing::c {

using NodesHandle = std::unique_ptr<rr_detected_nodes, Release<rr_detected_nodes_release>>;
using ServicesHandle = std::unique_ptr<rr_found_services, Release<rr_found_services_release>>;

/// A node of the C interface that listens where only this test announces.
class Announced : public ::testing::Test {
 protected:
  Announced() { listen(node_.get()); }

  void listen(rr_node* node, std::int32_t lifetime_ms = 0) const {
    const rr_str interface = view(network_.interfaces.at(0));
    rr_listen_options options{};
    options.size = sizeof options;
    options.networks = RR_IPV4_BROADCAST;
    options.port = network_.port;
    options.interfaces = &interface;
    options.interface_count = 1;
    options.lifetime_ms = lifetime_ms;
    options.without_local_nodes = 1;
    EXPECT_EQ(rr_discovery_listen(node, &options, nullptr), RR_OK);
  }
  rr_status announce(rr_node* node) const {
    const rr_str interface = view(network_.interfaces.at(0));
    rr_announce_options options{};
    options.size = sizeof options;
    options.networks = RR_IPV4_BROADCAST;
    options.port = network_.port;
    options.interfaces = &interface;
    options.interface_count = 1;
    options.period_ms = 500;
    return rr_discovery_announce(node, &options, nullptr);
  }
  /// A node with a counter of a colour.
  [[nodiscard]] std::unique_ptr<Node> serve(const std::string& name, const std::string& color) {
    auto node = std::make_unique<Node>(NodeOptions{.name = name});
    service_ = node->register_service("counter", std::make_shared<Counter>(name),
                                      {.attributes = {{"color", color}}});
    node->listen_tcp(0, "127.0.0.1");
    node->discovery().announce({.network = network_, .period = std::chrono::milliseconds(500)});
    return node;
  }

  const DiscoveryNetwork network_ = discovery::loopback_network();
  NodeHandle node_ = make_node();
  Service service_;  ///< of the node that was made last
};

inline rr_find_options waiting(std::int32_t wait_ms) {
  rr_find_options options{};
  options.size = sizeof options;
  options.wait_ms = wait_ms;
  return options;
}

inline std::vector<std::string> texts(const rr_str* given, std::size_t count) {
  std::vector<std::string> result;
  for (std::size_t i = 0; i < count; ++i) result.push_back(text(given[i]));
  return result;
}

inline rr_found_service read(const ServicesHandle& services, std::size_t place) {
  rr_found_service info{};
  info.size = sizeof info;
  EXPECT_EQ(rr_found_services_read(services.get(), place, &info, nullptr), RR_OK);
  return info;
}
inline rr_detected_node read(const NodesHandle& nodes, std::size_t place) {
  rr_detected_node info{};
  info.size = sizeof info;
  EXPECT_EQ(rr_detected_nodes_read(nodes.get(), place, &info, nullptr), RR_OK);
  return info;
}

}  // namespace rr::testing::c
