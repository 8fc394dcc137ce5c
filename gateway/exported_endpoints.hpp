// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <map>
#include <string>

#include "rr/dynamic.hpp"
#include "rr/mutex.hpp"

namespace rr::gateway {

/// Endpoints of the robot's pipes to which far clients send, by a name. May be used on any thread.
class ExportedEndpoints {
 public:
  using Clock = std::chrono::steady_clock;

  /// Keeps one. What the robot sends to it is dropped: packets to clients are logged from an
  /// endpoint of the gateway (service_streams.cpp).
  void add(const std::string& name, dynamic::PipeEndpoint end, Clock::time_point now);
  /// False when there is no open one. Throws as dynamic::PipeEndpoint::send().
  bool send(const std::string& name, const dynamic::List& packets, Clock::time_point now);
  /// Closes one, if it is there.
  void close(const std::string& name);
  /// Closes those that nobody has used for `idle`.
  void close_idle(Clock::time_point now, Clock::duration idle);

 private:
  struct Open {
    dynamic::PipeEndpoint end;
    Clock::time_point used;
  };
  Mutex mutex_;
  std::map<std::string, Open> open_ RR_GUARDED_BY(mutex_);
};

}  // namespace rr::gateway
