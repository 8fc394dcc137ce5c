// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "rr/definition.hpp"
#include "rr/stub.hpp"

namespace rr {

/// A function that waits for an event of one object; a base of those that wait for other things.
struct Subscription::Handler {
  Handler() = default;
  Handler(const Stub& of, const Member& event, std::unique_ptr<EventHandler> function)
      : stub(&of), path(of.rr_path()), member(&event), function_(std::move(function)) {}
  virtual ~Handler() = default;

  const Stub* const stub = nullptr;  // compared only
  const std::string path;
  const Member* const member = nullptr;

  /// Calls the function unless it has been disconnected. What it throws comes out.
  void call(const Arguments& arguments);
  /// Runs something else under the same terms.
  void run(const std::function<void()>& what);
  /// Returns when the function is not running any more, unless it is the caller.
  void disconnect();
  [[nodiscard]] bool is_connected() const { return is_connected_; }

 private:
  std::unique_ptr<EventHandler> function_;
  std::mutex mutex_;
  std::condition_variable ended_;
  std::atomic<bool> is_connected_{true};  // written under mutex_
  bool is_running_ = false;
  std::thread::id runner_;
};

}  // namespace rr
