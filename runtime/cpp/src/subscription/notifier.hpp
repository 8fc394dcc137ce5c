// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "rr/function.hpp"
#include "rr/mutex.hpp"
#include "rr/stub.hpp"
#include "runtime/cpp/src/endpoint/core.hpp"
#include "runtime/cpp/src/endpoint/subscription.hpp"

namespace rr::subscription {

/// Runs things one at a time, in order, on a thread of the node, under no lock. What they throw
/// goes to the node's log.
class Notifier : public std::enable_shared_from_this<Notifier> {
 public:
  explicit Notifier(std::shared_ptr<endpoint::Core> core) : core_(std::move(core)) {}

  /// May be called under a lock.
  void add(std::function<void()> work);

 private:
  void run();

  const std::shared_ptr<endpoint::Core> core_;
  Mutex mutex_;
  std::deque<std::function<void()>> work_ RR_GUARDED_BY(mutex_);
  bool is_running_ RR_GUARDED_BY(mutex_) = false;
};

/// A function of the program.
template <class... Arguments>
class Listener final : public Subscription::Handler {
 public:
  explicit Listener(Function<void(Arguments...)> function) : function_(std::move(function)) {}

  /// Whether it has been called. By one thread at a time.
  bool call(const std::decay_t<Arguments>&... arguments) {
    bool is_called = false;
    run([&] {
      is_called = true;
      function_(arguments...);
    });
    return is_called;
  }

 private:
  void drop() override { function_ = nullptr; }

  Function<void(Arguments...)> function_;
};

/// Functions that are told the same. Guarded by who has it.
template <class... Arguments>
class Listeners {
 public:
  using Each = std::shared_ptr<Listener<Arguments...>>;

  Each add(Function<void(Arguments...)> function) {
    auto listener = std::make_shared<Listener<Arguments...>>(std::move(function));
    // Functions of those that are disconnected are gone already.
    std::erase_if(all_, [](const Each& other) { return !other->is_connected(); });
    all_.push_back(listener);
    return listener;
  }
  /// Tells all that are there now.
  void notify(Notifier& notifier, const std::decay_t<Arguments>&... arguments) const {
    if (all_.empty()) return;
    notifier.add([all = all_, arguments...] {
      for (const Each& listener : all) listener->call(arguments...);
    });
  }
  /// Frees the functions, behind what they are still to be told.
  void end(Notifier& notifier) {
    if (all_.empty()) return;
    notifier.add([all = std::exchange(all_, {})] {
      for (const Each& listener : all) listener->disconnect();
    });
  }

 private:
  std::vector<Each> all_;
};

}  // namespace rr::subscription
