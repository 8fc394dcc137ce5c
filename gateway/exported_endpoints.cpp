// SPDX-License-Identifier: Apache-2.0
#include "gateway/exported_endpoints.hpp"

#include <utility>
#include <vector>

namespace rr::gateway {

void ExportedEndpoints::add(const std::string& name, dynamic::PipeEndpoint end,
                            Clock::time_point now) {
  end.on_packet([](const dynamic::Value&) {}).detach();
  const MutexLock lock(mutex_);
  open_[name] = {std::move(end), now};
}

bool ExportedEndpoints::send(const std::string& name, const dynamic::List& packets,
                             Clock::time_point now) {
  dynamic::PipeEndpoint end;
  {
    const MutexLock lock(mutex_);
    const auto found = open_.find(name);
    if (found == open_.end()) return false;
    if (!found->second.end.is_open()) {
      open_.erase(found);
      return false;
    }
    found->second.used = now;
    end = found->second.end;
  }
  for (const dynamic::Value& packet : packets) end.send(packet);
  return true;
}

void ExportedEndpoints::close(const std::string& name) {
  auto node = [&] {
    const MutexLock lock(mutex_);
    return open_.extract(name);
  }();
  // Waits for the robot.
  if (!node.empty()) node.mapped().end.close();
}

void ExportedEndpoints::close_idle(Clock::time_point now, Clock::duration idle) {
  std::vector<dynamic::PipeEndpoint> ended;
  {
    const MutexLock lock(mutex_);
    std::erase_if(open_, [&](auto& entry) {
      // One that has ended, perhaps with its session, needs no word to the robot.
      if (!entry.second.end.is_open()) return true;
      const bool is_idle = now - entry.second.used >= idle;
      if (is_idle) ended.push_back(std::move(entry.second.end));
      return is_idle;
    });
  }
  for (dynamic::PipeEndpoint& end : ended) end.close();
}

}  // namespace rr::gateway
