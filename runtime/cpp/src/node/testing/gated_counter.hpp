// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

#include "runtime/cpp/src/node/testing/counter.hpp"
#include "runtime/cpp/src/node/testing/gate.hpp"

namespace rr::testing {

/// A counter whose `reset` waits until the test lets it go on.
class GatedCounter : public Counter {
 public:
  void reset() override {
    gate.pass();
    is_done = true;
  }
  Gate gate;
  std::atomic<bool> is_done{false};
};

}  // namespace rr::testing
