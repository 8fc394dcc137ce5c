// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <vector>

#include "rr/discovery.hpp"
#include "runtime/c/src/border.hpp"
#include "runtime/c/src/elements.hpp"

/// What discovery finds, as the program reads it.
namespace rr::capi {

/// A node, with views of it.
class DetectedNodeView {
 public:
  explicit DetectedNodeView(DetectedNode node);
  DetectedNodeView(const DetectedNodeView&) = delete;
  DetectedNodeView& operator=(const DetectedNodeView&) = delete;
  [[nodiscard]] const rr_detected_node& info() const { return info_; }

 private:
  const DetectedNode node_;
  const std::vector<rr_str> urls_;
  rr_detected_node info_{};
};

/// A service, with views of it.
class FoundServiceView {
 public:
  explicit FoundServiceView(FoundService service);
  FoundServiceView(const FoundServiceView&) = delete;
  FoundServiceView& operator=(const FoundServiceView&) = delete;
  [[nodiscard]] const rr_found_service& info() const { return info_; }

 private:
  const FoundService service_;
  const std::vector<rr_str> urls_;
  const std::vector<rr_str> implements_;
  const Data attributes_;
  rr_found_service info_{};
};

/// New results for the program.
rr_detected_nodes* hand_out(std::vector<DetectedNode> nodes);
rr_found_services* hand_out(std::vector<FoundService> services);

}  // namespace rr::capi

struct rr_detected_nodes {
  std::deque<rr::capi::DetectedNodeView> views;
};
struct rr_found_services {
  std::deque<rr::capi::FoundServiceView> views;
};
