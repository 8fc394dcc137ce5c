// SPDX-License-Identifier: Apache-2.0
// What the packets of all endpoints of a session may make a service keep.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <vector>

#include "rr/pipes.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/pipe_boards.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""s;

constexpr std::size_t mebibyte = 1024 * 1024;

std::size_t open_count(const std::vector<PipeEndpoint<Array<std::uint8_t>>>& ends) {
  std::size_t count = 0;
  for (const auto& end : ends) count += end.is_open() ? 1 : 0;
  return count;
}

NodeOptions small_budget() {
  NodeOptions options;
  options.budget = {.before_session = 6 * mebibyte,
                    .sessions = 6 * mebibyte};  // one client gets 4 of it
  return options;
}

TEST(PipeBudget, IsOneForAllEndpointsOfASession) {
  PipeBoards boards(small_budget());
  auto board = boards.connect();
  std::vector<PipeEndpoint<Array<std::uint8_t>>> ends;
  for (int i = 0; i < 20; ++i) ends.push_back(board->blobs().connect());
  const Array<std::uint8_t> packet(100'000);
  // Nobody receives. No endpoint by itself has more than a megabyte.
  for (auto& end : ends) {
    for (int i = 0; i < 10 && end.is_open(); ++i) {
      if (code_of([&] { end.send(packet); }) != ErrorCode::none) break;
    }
    board->sync();
  }
  ASSERT_TRUE(eventually([&] { return open_count(ends) < 8; }));
  EXPECT_GE(open_count(ends), 2U);
  std::size_t held = 0;
  for (auto& end : boards.board->blobs().endpoints()) held += end.available() * packet.size();
  EXPECT_LE(held, 4 * mebibyte);
  EXPECT_GE(held, 1 * mebibyte);
}

TEST(PipeBudget, IsGivenBackByReceivingAndByLeaving) {
  PipeBoards boards(small_budget());
  const Array<std::uint8_t> packet(1 * mebibyte);
  // A message that is handled and its packet count both: three of these do not fit into four.
  for (int round = 0; round < 4; ++round) {
    auto board = boards.connect();
    auto end = board->blobs().connect();
    for (int i = 0; i < 2; ++i) end.send(packet);
    board->sync();
    auto served = boards.board->blobs().endpoints().at(0);
    ASSERT_EQ(served.available(), 2U);
    for (int i = 0; i < 2; ++i) EXPECT_EQ(served.receive().size(), packet.size());
    for (int i = 0; i < 2; ++i) end.send(packet);
    board->sync();
    EXPECT_EQ(served.available(), 2U);
    served = {};
    board.close();
    ASSERT_TRUE(eventually([&] { return boards.service->clients().empty(); }));
  }
}

TEST(PipeBudget, DropsTheOldestWhereTheEndpointDoes) {
  PipeBoards boards(small_budget());
  boards.board->blobs().on_connect([](PipeEndpoint<Array<std::uint8_t>> end) {
    end.set_queue_limit(1000, WhenFull::drop_oldest);
  });
  auto board = boards.connect();
  auto end = board->blobs().connect();
  for (std::uint8_t i = 0; i < 20; ++i) {
    Array<std::uint8_t> packet(500'000);
    packet.mutate()[0] = i;
    end.send(packet);
    board->sync();
  }
  auto served = boards.board->blobs().endpoints().at(0);
  EXPECT_TRUE(served.is_open());
  EXPECT_EQ(served.available() + served.lost_count(), 20U);
  EXPECT_GE(served.lost_count(), 10U);
  EXPECT_GE(served.available(), 2U);
  std::uint8_t last = 0;
  while (served.available() != 0) last = served.receive()[0];
  EXPECT_EQ(last, 19);
}

}  // namespace
}  // namespace rr::testing
