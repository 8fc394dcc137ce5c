// SPDX-License-Identifier: Apache-2.0
// Broadcasts, bounded queues and many senders of pipes.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <optional>
#include <vector>

#include "rr/pipes.hpp"
#include "runtime/cpp/src/node/testing/pipe_boards.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;

TEST(Pipes, ABroadcastReachesEveryEndpointInBothFormats) {
  NodeOptions old_format;
  old_format.client_offer.message_v4 = false;
  PipeBoards boards;
  Node old_client(old_format);
  auto new_board = boards.connect();
  auto old_board = old_client.connect<PipeBoardStub>(
      "rr+tcp://127.0.0.1:" + std::to_string(boards.port) + "/?service=board");
  std::vector<PipeEndpoint<std::optional<Reading>>> ends;
  for (auto* board : {&*new_board, &*old_board, &*new_board}) {
    ends.push_back(board->readings().connect());
  }
  Array<std::uint8_t> picture(100'000);
  picture.mutate()[99'999] = 9;
  const Reading small{1, "small", {}};
  const Reading large{2, "large", picture};
  boards.board->readings().send(small);
  boards.board->readings().send(large);
  boards.board->readings().send(std::nullopt);
  for (auto& end : ends) {
    EXPECT_EQ(end.receive_for(10s), small);
    EXPECT_EQ(end.receive_for(10s), large);
    ASSERT_TRUE(end.wait(10s));
    EXPECT_EQ(end.receive(), std::nullopt);
  }
}

TEST(Pipes, ABroadcastPassesOverWhoLagsBehind) {
  std::promise<void> go_on;
  auto held = go_on.get_future().share();
  PipeBoards boards;
  auto quick = boards.connect();
  Node slow_node;
  auto slow = slow_node.connect<PipeBoardStub>("rr+tcp://127.0.0.1:" + std::to_string(boards.port) +
                                               "/?service=board");
  auto quick_end = quick->numbers().connect();
  auto slow_end = slow->numbers().connect();
  auto blocker = slow->out().connect();
  // While this runs nothing of the slow session is handled.
  const auto subscription = blocker.on_packet([&](std::int32_t) { held.wait(); });
  boards.board->numbers().set_backlog_limit(10);
  boards.board->out().send(1);
  std::this_thread::sleep_for(50ms);
  for (int i = 0; i < 100; ++i) {
    boards.board->numbers().send(i);
    ASSERT_EQ(quick_end.receive_for(10s), i);
    for (auto& end : boards.board->numbers().endpoints()) {
      if (end.client() != boards.service->clients().front().endpoint) continue;
      ASSERT_TRUE(eventually([&] { return end.unacknowledged() == 0; }));
    }
  }
  go_on.set_value();
  ASSERT_TRUE(eventually([&] { return slow_end.available() == 11; }));
  for (int i = 0; i < 11; ++i) EXPECT_EQ(slow_end.receive(), i);
  EXPECT_TRUE(slow_end.is_open());
}

TEST(Pipes, AFullQueueDropsTheOldest) {
  PipeBoards boards;
  auto board = boards.connect();
  auto end = board->numbers().connect();
  end.set_queue_limit(3, WhenFull::drop_oldest);
  for (int i = 0; i < 10; ++i) boards.board->numbers().send(i);
  board->sync();
  ASSERT_TRUE(eventually([&] { return end.lost_count() == 7; }));
  EXPECT_EQ(end.receive(), 7);
  EXPECT_EQ(end.receive(), 8);
  EXPECT_EQ(end.receive(), 9);
}

TEST(Pipes, AFullQueueDropsTheNewest) {
  PipeBoards boards;
  auto board = boards.connect();
  auto end = board->numbers().connect();
  end.set_queue_limit(3, WhenFull::drop_newest);
  for (int i = 0; i < 10; ++i) boards.board->numbers().send(i);
  ASSERT_TRUE(eventually([&] { return end.lost_count() == 7; }));
  EXPECT_EQ(end.available(), 3U);
  EXPECT_EQ(end.receive(), 0);
}

TEST(Pipes, AFullQueueClosesTheEndpoint) {
  PipeBoards boards;
  boards.board->numbers().on_connect([](PipeEndpoint<double> end) { end.set_queue_limit(2); });
  auto board = boards.connect();
  auto end = board->numbers().connect();
  for (int i = 0; i < 3; ++i) end.send(i);
  EXPECT_TRUE(eventually([&] { return !end.is_open(); }));
  auto blobs = board->blobs().connect();
  blobs.set_queue_limit(100, WhenFull::close, 10'000);
  boards.board->blobs().send(Array<std::uint8_t>(20'000));
  EXPECT_TRUE(blobs.wait(10s));
  EXPECT_TRUE(blobs.is_open());
  boards.board->blobs().send(Array<std::uint8_t>(1));
  EXPECT_TRUE(eventually([&] { return boards.board->blobs().endpoint_count() == 0; }));
  EXPECT_FALSE(blobs.is_open());
  EXPECT_EQ(blobs.receive().size(), 20'000U);
}

TEST(Pipes, WhoSendsMoreThanIsTakenIsTold) {
  std::promise<void> go_on;
  auto held = go_on.get_future().share();
  NodeOptions options;
  options.send_queue_limit = 4'000'000;
  PipeBoards boards(options);
  auto board = boards.connect();
  auto end = board->blobs().connect();
  std::atomic<std::size_t> bytes{0};
  const auto subscription = end.on_packet([&](const Array<std::uint8_t>& packet) {
    held.wait();
    bytes += packet.size();
  });
  auto served = boards.board->blobs().endpoints().front();
  const Array<std::uint8_t> packet(100'000);
  std::size_t sent = 0;
  // What the system and the other side take meanwhile makes room again, but not for ever.
  do {
    Error error(ErrorCode::none, "");
    while (error.code() == ErrorCode::none) {
      error = error_of([&] { served.send(packet); });
      if (error.code() == ErrorCode::none) sent += packet.size();
      ASSERT_LT(sent, 500'000'000U);
    }
    ASSERT_EQ(error.code(), ErrorCode::buffer_limit_violation);
  } while (served.wait_sent(100ms));
  EXPECT_TRUE(served.is_open());
  go_on.set_value();
  EXPECT_TRUE(served.wait_sent(20s));
  served.send(packet);
  EXPECT_TRUE(eventually([&] { return bytes == sent + packet.size(); }));
}

TEST(Pipes, ABroadcastClosesWhoTakesNothing) {
  std::promise<void> go_on;
  auto held = go_on.get_future().share();
  NodeOptions options;
  options.send_queue_limit = 4'000'000;
  PipeBoards boards(options);
  auto board = boards.connect();
  auto end = board->blobs().connect();
  const auto subscription = end.on_packet([&](const Array<std::uint8_t>&) { held.wait(); });
  const Array<std::uint8_t> packet(100'000);
  for (int i = 0; i < 2000 && boards.board->blobs().endpoint_count() != 0; ++i) {
    boards.board->blobs().send(packet);
  }
  EXPECT_EQ(boards.board->blobs().endpoint_count(), 0U);
  go_on.set_value();
  EXPECT_TRUE(eventually([&] { return !end.is_open(); }));
  board->sync();  // the session stays
}

TEST(Pipes, ManyThreadsSendWithoutLossAndEachInOrder) {
  constexpr int threads = 4;
  constexpr int packets = 20'000;
  std::vector<int> next(threads);
  std::atomic<int> received{0};
  std::atomic<int> wrong{0};
  PipeBoards boards;
  boards.board->numbers().on_connect([&](PipeEndpoint<double> end) {
    end.on_packet([&](double value) {
         const int sender = static_cast<int>(value) / packets;
         const int number = static_cast<int>(value) % packets;
         if (next[static_cast<std::size_t>(sender)]++ != number) ++wrong;
         ++received;
       })
        .detach();
  });
  auto board = boards.connect();
  auto end = board->numbers().connect();
  {
    std::vector<std::jthread> senders;
    for (int i = 0; i < threads; ++i) {
      senders.emplace_back([&, i] {
        for (int k = 0; k < packets; ++k) end.send(i * packets + k);
      });
    }
  }
  EXPECT_TRUE(eventually([&] { return received == threads * packets; }));
  EXPECT_EQ(wrong, 0);
  EXPECT_TRUE(end.is_open());
}

}  // namespace
}  // namespace rr::testing
