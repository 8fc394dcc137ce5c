// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <exception>
#include <functional>
#include <memory>

#include "runtime/matlab/src/objects.hpp"

namespace rr::matlab {

/// Ends an asynchronous call: from any thread, once. The user's function is called from the queue
/// as `function(parameter, value, error)`.
class Completions {
 public:
  Completions(Runtime& runtime, std::uint64_t function)
      : runtime_(&runtime), queue_(runtime.queue()), function_(function) {}

  /// `make` gives the value on the interpreter's thread, if there is no error.
  void end(std::exception_ptr error, Function<mxArray*()> make) const;

 private:
  Runtime* runtime_;
  std::shared_ptr<Queue> queue_;
  std::uint64_t function_;
};

/// The user's function, and its first argument; `[]` for a function nobody wants.
struct Handler {
  const mxArray* function;
  const mxArray* parameter;
};

/// Starts a call that may take so long. What `start` throws is thrown.
void start_call(Runtime& runtime, const std::shared_ptr<Connection>& connection,
                const Handler& handler, std::chrono::milliseconds limit,
                const std::function<void(const Completions&)>& start);

}  // namespace rr::matlab
