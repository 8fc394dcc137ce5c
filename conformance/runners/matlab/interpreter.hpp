// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <rr/dynamic.hpp>

#include "runtime/matlab/src/values.hpp"

namespace rr::conformance {

/// The interpreter's thread, which alone may touch its values: others have it pass theirs.
class Interpreter {
 public:
  /// Runs the verb on a thread of its own, and what that asks for on this one, until it has ended.
  /// False for an unknown verb.
  bool run(const std::string& verb, const std::string& folder);
  [[nodiscard]] bool is_running() const { return is_running_; }

  /// A value as it is after the interpreter has had it: in its own form, through a function of
  /// its own. On any thread. Throws rr::Error.
  dynamic::Value pass(const dynamic::Definitions& definitions, const dynamic::ValueType& type,
                      const dynamic::Value& value);

 private:
  void push(std::function<void()> work);
  matlab::Plans& plans_of(const dynamic::Definitions& definitions);
  dynamic::Value pass_here(const dynamic::Definitions& definitions, const dynamic::ValueType& type,
                           const dynamic::Value& value);

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> work_;
  bool is_running_ = false;
  bool has_ended_ = false;
  // By the definitions' tables, which the plans keep. For the interpreter's thread.
  std::map<std::shared_ptr<const dynamic::Tables>, std::unique_ptr<matlab::Plans>> plans_;
};

}  // namespace rr::conformance
