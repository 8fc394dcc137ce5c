// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <thread>

#include "rr/mutex.hpp"
#include "rr/node.hpp"

namespace rr {

/// Tells the service manager twice in each of its periods that the node is alive: after a timer of
/// the node has been run, which takes both the thread that watches and the one that polls. A node
/// that does not run it in time is not reported, and is restarted.
class Watchdog {
 public:
  /// `period`: that of the service manager; zero: nothing is done.
  Watchdog(Node& node, std::chrono::microseconds period);
  /// Waits for a round that has begun.
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

 private:
  void run();
  bool turns();

  Node& node_;
  const std::chrono::microseconds pause_;
  Mutex mutex_;
  Condition over_;
  bool is_over_ RR_GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace rr
