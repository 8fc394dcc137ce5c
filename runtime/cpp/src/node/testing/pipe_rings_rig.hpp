// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "runtime/cpp/src/node/testing/pipe_board.hpp"
#include "runtime/cpp/src/node/testing/shared_nodes.hpp"
#include "runtime/cpp/src/node/testing/wired.hpp"

namespace rr::testing {

/// Memories of pipes that this process has mapped: to put packets in, or to read.
inline std::size_t rings_served() { return mapped(3, true); }
inline std::size_t rings_read() { return mapped(3, false); }

/// A service with pipes.
class PipeRings : public SharedNodes<PipeBoard, PipeBoardStub> {
 protected:
  PipeRings() : SharedNodes("board") {}

  using Numbers = PipeEndpoint<double>;
  Numbers connect_numbers() { return connect(options())->numbers().connect(); }
  std::vector<Numbers> connect_numbers(std::size_t count) {
    std::vector<Numbers> ends;
    while (ends.size() < count) ends.push_back(connect_numbers());
    return ends;
  }
  void send(int first, int last) const {
    for (int number = first; number <= last; ++number) object_->numbers().send(number);
  }
  // Each number once, and in order.
  static void expect_numbers(Numbers& end, int first, int last) {
    for (int number = first; number <= last; ++number) {
      const auto packet = end.receive_for(plenty);
      ASSERT_TRUE(packet) << number;
      ASSERT_EQ(*packet, number);
    }
  }
};

}  // namespace rr::testing
