// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "rr/definition.hpp"
#include "rr/stub.hpp"

namespace rr {

/// A function that waits for an event of one object.
struct Subscription::Handler {
  Handler(const Stub& of, const Member& event, std::unique_ptr<EventHandler> function)
      : stub(&of), path(of.rr_path()), member(&event), function_(std::move(function)) {}

  const Stub* const stub;  // compared only
  const std::string path;
  const Member* const member;

  /// Calls the function unless it has been disconnected. What it throws comes out.
  void call(const Arguments& arguments);
  /// Returns when the function is not running any more, unless it is the caller. It goes, with what
  /// it owns, as soon as it does not run.
  void disconnect();
  [[nodiscard]] bool is_connected() const { return is_connected_; }

 private:
  std::unique_ptr<EventHandler> function_;
  std::mutex mutex_;
  std::condition_variable ended_;
  std::atomic<bool> is_connected_{true};  // written under mutex_
  bool is_running_ = false;
  bool is_left_to_runner_ = false;  // the function has disconnected itself
  std::thread::id runner_;
};

}  // namespace rr
