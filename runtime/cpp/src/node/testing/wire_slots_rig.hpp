// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "runtime/cpp/src/node/testing/shared_nodes.hpp"
#include "runtime/cpp/src/node/testing/wired.hpp"

namespace rr::testing {

/// Memories of wires that this process has mapped: to publish, or to read.
inline std::size_t published() { return mapped(2, true); }
inline std::size_t read_here() { return mapped(2, false); }
inline std::vector<std::uint64_t> published_ids() { return published_ids(2); }

/// So that the first one is the number, and the size says the same.
inline Array<double> trace_of(std::size_t size, double number) {
  Array<double> trace(size);
  std::ranges::fill(trace.mutate(), number);
  return trace;
}

/// A service with wires.
class WireSlots : public SharedNodes<Wired, WiredStub> {
 protected:
  WireSlots() : SharedNodes("wired") {}
};

/// Items of an array that is read in its slot.
inline constexpr std::size_t large = 50'000;

}  // namespace rr::testing
