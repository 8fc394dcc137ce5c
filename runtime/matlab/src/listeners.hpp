// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mex.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "runtime/matlab/src/runtime.hpp"

namespace rr::matlab {

/// Functions of the user's that hear when one thing happens, as the end of a session. Threads of
/// the node tell it, and the functions are called in Poll. The list is for the interpreter's
/// thread.
class Listeners {
 public:
  explicit Listeners(Runtime& runtime) : runtime_(runtime), queue_(runtime.queue()) {}

  void add(std::uint64_t function) { functions_.push_back(function); }

  /// On any thread. `make` gives the arguments of one call, on the interpreter's thread.
  static void tell(const std::shared_ptr<Listeners>& listeners,
                   std::function<std::vector<mxArray*>()> make);
  /// The same, and then they go.
  static void tell_last(const std::shared_ptr<Listeners>& listeners,
                        std::function<std::vector<mxArray*>()> make);

 private:
  void call(const std::function<std::vector<mxArray*>()>& make);

  Runtime& runtime_;
  const std::shared_ptr<Queue> queue_;
  std::vector<std::uint64_t> functions_;
};

}  // namespace rr::matlab
