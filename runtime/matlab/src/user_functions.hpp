// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mex.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "rr/dynamic.hpp"
#include "rr/matlab/failure.hpp"
#include "runtime/matlab/src/kept.hpp"
#include "runtime/matlab/src/plans.hpp"
#include "runtime/matlab/src/queue.hpp"

namespace rr::matlab {

class Connection;

/// A function of the user's that is called when something comes.
struct UserFunction {
  Kept function;
  Kept parameter;  ///< of asynchronous calls
  /// Somebody waits for its result: a callback's.
  bool is_waited_for = false;
  /// False from when it is to be called no more; for other threads.
  std::shared_ptr<std::atomic<bool>> is_open = std::make_shared<std::atomic<bool>>(true);
  /// Of a callback, an event: how arguments and result are converted.
  dynamic::MemberDescription member;
  std::weak_ptr<Connection> connection;
  /// Ends the runtime's calls to it. Destroyed when the function is removed.
  std::shared_ptr<void> subscription;
};

/// The functions of the user's by numbers, which is what threads of the node know of them. For the
/// interpreter's thread.
class UserFunctions {
 public:
  std::uint64_t add(UserFunction function);
  /// Null when it is none, any more.
  UserFunction* find(std::uint64_t number);
  /// Other threads put nothing into the queue for it any more.
  void close(std::uint64_t number);
  /// Waits for a thread that is just about to put something into the queue.
  void remove(std::uint64_t number);
  void clear();
  /// See Kept::abandon().
  void abandon();
  /// Whether there is one that somebody waits for, so that the interpreter's thread must not block
  /// without looking at the queue.
  [[nodiscard]] bool has_callbacks() const { return waited_for_count_ != 0; }

  struct Outcome {
    std::optional<Failure> failure;
    mxArray* result = nullptr;  ///< if wanted and given
  };
  /// Calls a function of the user's. The arguments are destroyed.
  static Outcome run(const Kept& function, std::vector<mxArray*> arguments, bool wants_result);
  /// The same for one that nobody waits for: a failure becomes a warning.
  static void run_alone(const Kept& function, std::vector<mxArray*> arguments);

 private:
  std::map<std::uint64_t, UserFunction> functions_;
  std::uint64_t last_ = 0;
  std::size_t waited_for_count_ = 0;
};

}  // namespace rr::matlab
