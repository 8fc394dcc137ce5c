// SPDX-License-Identifier: Apache-2.0
// What the robot's service has closed is closed for clients here.
#include <utility>

#include "gateway/far_service.hpp"
#include "rr/error.hpp"

namespace rr::gateway {

void FarService::take_closed(const Closed& closed) {
  if (!closed.member.empty()) {
    const auto wire = wires_.find(member_topic(address_, closed.path, closed.member));
    if (wire == wires_.end()) return;
    const auto server = wire->second.object.wire(wire->second.member.name);
    for (dynamic::ServedWire& end : server.connections()) end.close();
  } else if (!closed.path.empty()) {
    release(closed.path);
  } else {
    shared_.log(LogLevel::warning, topic_ + ": what the robot has closed is not known any more");
    release_all();
  }
}

// A later request of a client asks the robot for the object anew.
void FarService::release(const std::string& path) {
  if (!service_ || !objects_.contains(path)) return;
  try {
    (*service_)->release_path(served_.name + "." + path);
  } catch (const Error&) {
    // No client has it.
  }
}

void FarService::release_all() {
  std::vector<std::string> paths;
  for (const auto& [path, object] : objects_) {
    if (!path.empty()) paths.push_back(path);
  }
  for (const std::string& path : paths) release(path);
  for (const auto& [topic, wire] : wires_) {
    for (dynamic::ServedWire& end : wire.object.wire(wire.member.name).connections()) end.close();
  }
}

}  // namespace rr::gateway
