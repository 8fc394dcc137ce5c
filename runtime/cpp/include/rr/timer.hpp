// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "rr/node_id.hpp"
#include "rr/options.hpp"
#include "rr/visibility.hpp"

/// Functions that a node calls at their time.
namespace RR_VISIBLE rr {

/// A function that is called again and again, or once: see NodeContext. Ends with cancel(), when it
/// is destroyed, or when its node is shut down.
class [[nodiscard]] Timer {
 public:
  /// For the runtime: what the node calls.
  class State;  // internal

  /// No timer: not running.
  Timer() = default;
  /// For the runtime: NodeContext::every() and after() make it.
  explicit Timer(std::shared_ptr<State> state) : state_(std::move(state)) {}
  /// Takes over the timer.
  Timer(Timer&&) = default;
  /// Cancels this timer, and takes over the other one.
  Timer& operator=(Timer&& other) noexcept;
  ~Timer() { cancel(); }

  /// The function runs no more once this returns, unless it is the caller itself.
  void cancel();
  /// False after cancel(), after the only call of a timer that calls once, and without a function.
  [[nodiscard]] bool is_running() const;

 private:
  std::shared_ptr<State> state_;
};

/// What an object knows of the node that serves it: ServiceContext::node().
class NodeContext {
 public:
  virtual ~NodeContext() = default;

  /// The id of the node.
  [[nodiscard]] virtual const NodeId& id() const = 0;
  /// Empty for a node without a name.
  [[nodiscard]] virtual const std::string& name() const = 0;
  /// Says something where the node's own messages go (NodeOptions::log). Never throws.
  virtual void log(LogLevel level, std::string_view text) const = 0;

  /// Calls `work` every `period`, first after one: on a thread of the node, one call at a time. A
  /// call that takes longer than the period leaves out those that it overlaps. What `work` throws
  /// is logged, and the timer goes on. Times are kept to a millisecond or so; for loops that need
  /// more see rr/realtime/. Throws rr::Error: invalid_argument for a period that is not positive or
  /// an empty function, invalid_operation after shutdown.
  virtual Timer every(std::chrono::nanoseconds period, std::function<void()> work) = 0;
  /// Calls `work` once, after `delay`. Throws as every().
  virtual Timer after(std::chrono::nanoseconds delay, std::function<void()> work) = 0;
};

}  // namespace rr
