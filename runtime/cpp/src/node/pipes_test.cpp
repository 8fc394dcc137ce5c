// SPDX-License-Identifier: Apache-2.0
// Pipes between a service and its clients.
#include "rr/pipes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <boost/asio/use_future.hpp>
#include <chrono>
#include <future>
#include <limits>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "rr/async.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/pipe_board.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using ::testing::ElementsAre;

struct Boards {
  explicit Boards(NodeOptions server_options = {}, NodeOptions client_options = {})
      : server(std::move(server_options)), client(std::move(client_options)) {
    service = server.register_service("board", board);
    port = server.listen_tcp(0, "127.0.0.1");
  }
  Client<PipeBoardStub> connect() {
    return client.connect<PipeBoardStub>("rr+tcp://127.0.0.1:" + std::to_string(port) +
                                         "/?service=board");
  }

  // Kept by the test: what functions refer to must outlive the nodes.
  std::shared_ptr<PipeBoard> board = std::make_shared<PipeBoard>();
  Node server;
  Node client;
  Service service;
  std::uint16_t port = 0;
};

// What a function has got, from any thread.
template <class T>
class Log {
 public:
  void add(T item) {
    const std::lock_guard lock(mutex_);
    items_.push_back(std::move(item));
  }
  [[nodiscard]] std::vector<T> items() const {
    const std::lock_guard lock(mutex_);
    return items_;
  }
  [[nodiscard]] std::size_t size() const { return items().size(); }

 private:
  mutable std::mutex mutex_;
  std::vector<T> items_;
};

class PipesInFormat : public ::testing::TestWithParam<bool> {
 protected:
  [[nodiscard]] static NodeOptions options() {
    NodeOptions options;
    options.client_offer.message_v4 = GetParam();
    return options;
  }
};
INSTANTIATE_TEST_SUITE_P(Formats, PipesInFormat, ::testing::Bool());

TEST_P(PipesInFormat, PacketsGoBothWaysInOrder) {
  Boards boards({}, options());
  auto board = boards.connect();
  auto end = board->numbers().connect();
  EXPECT_EQ(end.index(), 1);
  EXPECT_EQ(end.client(), 0U);
  EXPECT_TRUE(end.is_open());
  EXPECT_EQ(end.send(1.5), 1U);
  EXPECT_EQ(end.send(-2.5), 2U);
  board->sync();
  const auto served = boards.board->numbers().endpoints();
  ASSERT_EQ(served.size(), 1U);
  auto other = served.front();
  EXPECT_EQ(other.index(), 1);
  EXPECT_EQ(other.client(), boards.service->clients().front().endpoint);
  EXPECT_EQ(other.available(), 2U);
  EXPECT_EQ(other.peek(), 1.5);
  EXPECT_EQ(other.receive(), 1.5);
  EXPECT_EQ(other.receive(), -2.5);
  EXPECT_EQ(error_of([&] { other.receive(); }).code(), ErrorCode::invalid_operation);
  EXPECT_EQ(other.send(7), 1U);
  EXPECT_EQ(other.send(8), 2U);
  EXPECT_EQ(end.receive_for(10s), 7);
  EXPECT_EQ(end.receive_for(10s), 8);
  EXPECT_EQ(end.try_receive(), std::nullopt);
  EXPECT_EQ(end.receive_for(20ms), std::nullopt);
}

TEST_P(PipesInFormat, PacketsMayBeAnyValue) {
  Boards boards({}, options());
  auto board = boards.connect();
  auto readings = board->readings().connect();
  auto blobs = board->blobs().connect();
  readings.send(Reading{2.5, "left", {1, 2}});
  readings.send(std::nullopt);
  Array<std::uint8_t> large(3'000'000);
  large.mutate()[2'999'999] = 77;
  blobs.send(large);
  board->sync();
  auto served = boards.board->readings().endpoints().front();
  EXPECT_EQ(served.receive(), (Reading{2.5, "left", {1, 2}}));
  EXPECT_EQ(served.receive(), std::nullopt);
  EXPECT_EQ(boards.board->blobs().endpoints().front().receive(), large);
  boards.board->blobs().send(large);
  EXPECT_EQ(blobs.receive_for(10s), large);
}

TEST_P(PipesInFormat, AcknowledgementsSayWhichPacketsHaveArrived) {
  Log<std::uint32_t> acknowledged;
  Boards boards({}, options());
  auto board = boards.connect();
  auto end = board->numbers().connect();
  end.on_acknowledged([&](std::uint32_t number) { acknowledged.add(number); });
  end.send(1);
  end.ask_for_acknowledgements();
  end.send(2);
  end.send(3);
  EXPECT_TRUE(eventually([&] { return acknowledged.size() == 2; }));
  EXPECT_THAT(acknowledged.items(), ElementsAre(2U, 3U));
  EXPECT_EQ(end.unacknowledged(), 0U);
  auto served = boards.board->numbers().endpoints().front();
  served.ask_for_acknowledgements();
  served.send(4);
  EXPECT_TRUE(eventually([&] { return served.unacknowledged() == 0; }));
}

TEST_P(PipesInFormat, UnreliableEndpointsAreAgreedOn) {
  Boards boards({}, options());
  auto board = boards.connect();
  auto lossy = board->lossy().connect();
  EXPECT_TRUE(lossy.is_unreliable());
  lossy.ask_for_acknowledgements();
  lossy.send(5);
  EXPECT_TRUE(eventually([&] { return lossy.unacknowledged() == 0; }));
  auto served = boards.board->lossy().endpoints().front();
  EXPECT_TRUE(served.is_unreliable());
  EXPECT_EQ(served.receive(), 5);
  boards.board->lossy().send(6);
  EXPECT_EQ(lossy.receive_for(10s), 6);
  EXPECT_FALSE(board->lossy().connect({.unreliable = false}).is_unreliable());
  EXPECT_FALSE(board->numbers().connect({.unreliable = true}).is_unreliable());
}

TEST(Pipes, TheServiceChoosesIndexesAsTheReferenceDoes) {
  Boards boards;
  auto board = boards.connect();
  const auto index = [&](std::int32_t wanted) {
    return board->numbers().connect({.index = wanted}).index();
  };
  EXPECT_EQ(index(-1), 1);
  EXPECT_EQ(index(-1), 2);
  EXPECT_EQ(index(2), 3);
  EXPECT_EQ(index(10), 10);
  EXPECT_EQ(index(-5), 11);
  EXPECT_EQ(index(std::numeric_limits<std::int32_t>::max()),
            std::numeric_limits<std::int32_t>::max());
  EXPECT_EQ(error_of([&] { index(std::numeric_limits<std::int32_t>::max()); }).code(),
            ErrorCode::out_of_system_resource);
  EXPECT_EQ(boards.board->numbers().endpoint_count(), 6U);
  auto other = boards.connect();
  EXPECT_EQ(other->numbers().connect({.index = -5}).index(), -5);
  EXPECT_EQ(other->numbers().connect().index(), 1);
}

TEST(Pipes, AForbiddenDirectionIsRefusedWhereItIsSent) {
  Boards boards;
  auto board = boards.connect();
  auto out = board->out().connect();
  const Error refused = error_of([&] { out.send(1); });
  EXPECT_EQ(refused.code(), ErrorCode::read_only_member);
  EXPECT_EQ(refused.message(), "Read only pipe");
  boards.board->out().send(3);
  EXPECT_EQ(out.receive_for(10s), 3);
  auto in = board->in().connect();
  in.send("hello");
  board->sync();
  auto served = boards.board->in().endpoints().front();
  EXPECT_EQ(served.receive(), "hello");
  EXPECT_EQ(error_of([&] { served.send("no"); }).code(), ErrorCode::write_only_member);
  EXPECT_EQ(error_of([&] { boards.board->in().send("no"); }).code(), ErrorCode::write_only_member);
}

TEST(Pipes, PacketsSentBeforeTheAnswerAreKept) {
  Boards boards;
  boards.board->numbers().on_connect([](PipeEndpoint<double> end) {
    for (int i = 0; i < 100; ++i) end.send(i);
  });
  auto board = boards.connect();
  auto end = board->numbers().connect();
  for (int i = 0; i < 100; ++i) ASSERT_EQ(end.receive_for(10s), i);
  auto future = board->numbers().async_connect(boost::asio::use_future);
  auto second = future.get();
  EXPECT_EQ(second.index(), 2);
  for (int i = 0; i < 100; ++i) ASSERT_EQ(second.receive_for(10s), i);
}

TEST(Pipes, FunctionsGetPacketsInOrderThoseThatWaitFirst) {
  Log<double> received;
  Boards boards;
  auto board = boards.connect();
  auto end = board->numbers().connect();
  for (int i = 0; i < 5; ++i) boards.board->numbers().send(i);
  ASSERT_TRUE(eventually([&] { return end.available() == 5; }));
  Subscription subscription = end.on_packet([&](double packet) { received.add(packet); });
  for (int i = 5; i < 200; ++i) boards.board->numbers().send(i);
  ASSERT_TRUE(eventually([&] { return received.size() == 200; }));
  const auto items = received.items();
  for (std::size_t i = 0; i < items.size(); ++i) EXPECT_EQ(items[i], static_cast<double>(i));
  subscription.disconnect();
  boards.board->numbers().send(-1);
  EXPECT_EQ(end.receive_for(10s), -1);
  EXPECT_EQ(received.size(), 200U);
}

TEST(Pipes, AFunctionMayCallCloseAndUnsubscribe) {
  std::atomic<int> calls{0};
  std::atomic<bool> is_closed{false};
  Boards boards;
  auto board = boards.connect();
  auto end = board->numbers().connect();
  end.on_closed([&] { is_closed = true; });
  std::promise<Subscription*> self;
  auto future = self.get_future().share();
  Subscription subscription = end.on_packet([&, end](double) mutable {
    ++calls;
    board->sync();
    end.send(1);
    end.close();
    future.get()->disconnect();
  });
  self.set_value(&subscription);
  boards.board->numbers().send(1);
  boards.board->numbers().send(2);
  EXPECT_TRUE(eventually([&] { return is_closed.load(); }));
  EXPECT_EQ(calls, 1);
  EXPECT_FALSE(end.is_open());
  EXPECT_TRUE(eventually([&] { return boards.board->numbers().endpoint_count() == 0; }));
}

TEST(Pipes, WhatAFunctionThrowsIsLogged) {
  Log<std::string> reports;
  NodeOptions options;
  options.log = [&](LogLevel, std::string_view text) { reports.add(std::string(text)); };
  Boards boards({}, options);
  auto board = boards.connect();
  auto end = board->numbers().connect();
  const auto subscription = end.on_packet([](double) { throw std::runtime_error("not this one"); });
  boards.board->numbers().send(1);
  ASSERT_TRUE(eventually([&] { return reports.size() == 1; }));
  EXPECT_THAT(reports.items().front(), ::testing::HasSubstr("not this one"));
  board->sync();
}

TEST(Pipes, TheClientCloses) {
  std::atomic<int> closed{0};
  Boards boards;
  boards.board->numbers().on_connect(
      [&](PipeEndpoint<double> end) { end.on_closed([&] { ++closed; }); });
  auto board = boards.connect();
  auto end = board->numbers().connect();
  auto served = boards.board->numbers().endpoints().front();
  end.on_closed([&] { closed += 10; });
  end.send(5);
  end.close();
  end.close();
  EXPECT_FALSE(end.is_open());
  EXPECT_FALSE(served.is_open());
  EXPECT_EQ(boards.board->numbers().endpoint_count(), 0U);
  EXPECT_TRUE(eventually([&] { return closed == 11; }));
  EXPECT_EQ(error_of([&] { end.send(1); }).code(), ErrorCode::invalid_operation);
  EXPECT_EQ(error_of([&] { served.send(1); }).code(), ErrorCode::invalid_operation);
  EXPECT_EQ(served.receive(), 5);
  EXPECT_FALSE(served.wait(10s));
  EXPECT_EQ(board->numbers().connect().index(), 1);
}

TEST(Pipes, TheServiceCloses) {
  std::atomic<int> closed{0};
  Boards boards;
  auto board = boards.connect();
  auto end = board->numbers().connect();
  end.on_closed([&] { ++closed; });
  auto served = boards.board->numbers().endpoints().front();
  served.send(1);
  served.close();
  EXPECT_EQ(boards.board->numbers().endpoint_count(), 0U);
  EXPECT_TRUE(eventually([&] { return closed == 1; }));
  EXPECT_FALSE(end.is_open());
  EXPECT_EQ(end.receive(), 1);
  end.close();
  std::atomic<bool> is_told{false};
  end.on_closed([&] { is_told = true; });
  EXPECT_TRUE(eventually([&] { return is_told.load(); }));
}

TEST(Pipes, TheServiceMayRefuseAnEndpoint) {
  Boards boards;
  boards.board->numbers().on_connect([](PipeEndpoint<double> end) {
    if (end.index() == 7) throw Error(ErrorCode::permission_denied, "not seven");
    if (end.index() == 8) end.close();
  });
  auto board = boards.connect();
  const Error refused = error_of([&] { board->numbers().connect({.index = 7}); });
  EXPECT_EQ(refused.code(), ErrorCode::permission_denied);
  EXPECT_EQ(refused.message(), "not seven");
  EXPECT_EQ(error_of([&] { board->numbers().connect({.index = 8}); }).code(),
            ErrorCode::invalid_operation);
  auto future = board->numbers().async_connect(boost::asio::use_future, {.index = 7});
  EXPECT_THROW(future.get(), Error);
  EXPECT_EQ(boards.board->numbers().endpoint_count(), 0U);
  EXPECT_EQ(board->numbers().connect({.index = 9}).index(), 9);
}

TEST(Pipes, TheEndOfASessionEndsItsEndpoints) {
  std::atomic<int> closed{0};
  Boards boards;
  PipeEndpoint<double> end;
  PipeEndpoint<double> served;
  std::future<double> waiting;
  {
    auto board = boards.connect();
    end = board->numbers().connect();
    end.on_closed([&] { ++closed; });
    served = boards.board->numbers().endpoints().front();
    served.on_closed([&] { ++closed; });
    waiting = end.async_receive(boost::asio::use_future);
  }
  EXPECT_TRUE(eventually([&] { return closed == 2; }));
  EXPECT_FALSE(end.is_open());
  EXPECT_FALSE(served.is_open());
  EXPECT_THROW(waiting.get(), Error);
  EXPECT_EQ(boards.board->numbers().endpoint_count(), 0U);
  EXPECT_EQ(error_of([&] { served.send(1); }).code(), ErrorCode::invalid_operation);
}

TEST(Pipes, TheEndOfAServiceEndsItsEndpoints) {
  std::atomic<int> closed{0};
  Boards boards;
  auto board = boards.connect();
  auto end = board->numbers().connect();
  end.on_closed([&] { ++closed; });
  auto served = boards.board->numbers().endpoints().front();
  served.on_closed([&] { ++closed; });
  auto waiting = std::async(std::launch::async, [&] { return end.wait(10s); });
  served.send(3);
  EXPECT_TRUE(waiting.get());
  waiting = std::async(std::launch::async, [&] {
    end.receive();
    return end.wait(10s);
  });
  boards.service->close();
  EXPECT_FALSE(waiting.get());
  EXPECT_TRUE(eventually([&] { return closed == 2; }));
}

TEST(Pipes, TheReleaseOfAnObjectEndsItsEndpoints) {
  std::atomic<int> closed{0};
  Boards boards;
  boards.board->child = std::make_shared<PipeBoard>();
  auto board = boards.connect();
  auto child = board->get_child();
  auto end = child->numbers().connect();
  end.on_closed([&] { ++closed; });
  auto kept = board->numbers().connect();
  auto served = boards.board->child->numbers().endpoints().front();
  served.on_closed([&] { ++closed; });
  boards.service->release_path("board.child");
  EXPECT_TRUE(eventually([&] { return closed == 2; }));
  EXPECT_FALSE(end.is_open());
  EXPECT_TRUE(kept.is_open());
  EXPECT_EQ(child->numbers().connect().index(), 1);
}

TEST(Pipes, ABroadcastReachesEveryEndpointInBothFormats) {
  NodeOptions old_format;
  old_format.client_offer.message_v4 = false;
  Boards boards;
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
  Boards boards;
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
  Boards boards;
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
  Boards boards;
  auto board = boards.connect();
  auto end = board->numbers().connect();
  end.set_queue_limit(3, WhenFull::drop_newest);
  for (int i = 0; i < 10; ++i) boards.board->numbers().send(i);
  ASSERT_TRUE(eventually([&] { return end.lost_count() == 7; }));
  EXPECT_EQ(end.available(), 3U);
  EXPECT_EQ(end.receive(), 0);
}

TEST(Pipes, AFullQueueClosesTheEndpoint) {
  Boards boards;
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

TEST(Pipes, PacketsCanBeAwaited) {
  Boards boards;
  auto board = boards.connect();
  auto end = board->numbers().connect();
  auto first = end.async_receive(boost::asio::use_future);
  auto second = end.async_receive(boost::asio::use_future);
  boards.board->numbers().send(1);
  boards.board->numbers().send(2);
  boards.board->numbers().send(3);
  EXPECT_EQ(first.get(), 1);
  EXPECT_EQ(second.get(), 2);
  ASSERT_TRUE(end.wait(10s));
  EXPECT_EQ(end.async_receive(boost::asio::use_future).get(), 3);
}

TEST(Pipes, AValueThatMayNotTravelTakesNoNumber) {
  NodeOptions small;
  small.limits.message_size = 100'000;
  Boards boards({}, small);
  auto board = boards.connect();
  auto end = board->blobs().connect();
  EXPECT_EQ(error_of([&] { end.send(Array<std::uint8_t>(200'000)); }).code(),
            ErrorCode::protocol_error);
  EXPECT_EQ(end.send(Array<std::uint8_t>{1}), 1U);
  board->sync();
  EXPECT_EQ(boards.board->blobs().endpoints().front().receive(), Array<std::uint8_t>{1});
}

TEST(Pipes, WhoSendsMoreThanIsTakenIsTold) {
  std::promise<void> go_on;
  auto held = go_on.get_future().share();
  NodeOptions options;
  options.send_queue_limit = 4'000'000;
  Boards boards(options);
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
  Boards boards(options);
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
  Boards boards;
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

TEST(Pipes, AnAnswerComesBehindThePacketsThatWereSentBefore) {
  Boards boards;
  boards.board->on_sync = [&] {
    for (int i = 0; i < 1000; ++i) boards.board->numbers().send(i);
  };
  auto board = boards.connect();
  auto end = board->numbers().connect();
  Log<double> received;
  const auto subscription = end.on_packet([&](double packet) { received.add(packet); });
  board->sync();
  EXPECT_TRUE(eventually([&] { return received.size() == 1000; }));
}

TEST(Pipes, ASingleBurstArrivesWithoutAnythingBehindIt) {
  Boards boards;
  auto board = boards.connect();
  auto end = board->numbers().connect();
  for (int round = 0; round < 20; ++round) {
    for (int i = 0; i < 50; ++i) boards.board->numbers().send(i);
    for (int i = 0; i < 50; ++i) ASSERT_EQ(end.receive_for(10s), i);
  }
}

TEST(Pipes, EndpointsComeAndGoWhileOthersSend) {
  std::atomic<bool> is_over{false};
  Boards boards;
  std::jthread sender([&] {
    while (!is_over) {
      boards.board->numbers().send(1);
      std::this_thread::yield();
    }
  });
  std::vector<std::jthread> clients;
  for (int i = 0; i < 3; ++i) {
    clients.emplace_back([&] {
      for (int round = 0; round < 15; ++round) {
        auto board = boards.connect();
        auto first = board->numbers().connect();
        auto second = board->numbers().connect();
        EXPECT_TRUE(first.wait(20s));
        EXPECT_TRUE(second.wait(20s));
        if (round % 2 == 0) first.close();
      }
    });
  }
  clients.clear();
  is_over = true;
  sender.join();
  EXPECT_TRUE(eventually([&] { return boards.board->numbers().endpoint_count() == 0; }));
}

TEST(Pipes, ANodeMayGoWhileItsEndpointsAreUsed) {
  std::atomic<bool> is_over{false};
  std::atomic<int> closed{0};
  auto boards = std::make_unique<Boards>();
  const auto object = boards->board;
  auto board = boards->connect();
  auto end = board->numbers().connect();
  end.on_closed([&] { ++closed; });
  auto served = object->numbers().endpoints().front();
  served.on_closed([&] { ++closed; });
  std::vector<std::jthread> users;
  for (auto* each : {&end, &served}) {
    users.emplace_back([&is_over, mine = *each]() mutable {
      while (!is_over) {
        try {
          mine.send(1);
          static_cast<void>(mine.try_receive());
        } catch (const Error&) {
          if (!mine.is_open()) return;
        }
      }
    });
  }
  std::this_thread::sleep_for(20ms);
  boards.reset();
  is_over = true;
  users.clear();
  EXPECT_EQ(closed, 2);
  EXPECT_FALSE(end.is_open());
  EXPECT_FALSE(served.is_open());
  end.close();
}

TEST(Pipes, AHandleWithoutAnEndIsRefused) {
  PipeEndpoint<double> none;
  EXPECT_FALSE(none.is_open());
  none.close();
  EXPECT_EQ(error_of([&] { none.send(1); }).code(), ErrorCode::invalid_operation);
}

}  // namespace
}  // namespace rr::testing
