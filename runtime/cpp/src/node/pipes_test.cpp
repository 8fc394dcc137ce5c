// SPDX-License-Identifier: Apache-2.0
// Packets between a service and its clients.
#include "rr/pipes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <boost/asio/use_future.hpp>
#include <chrono>
#include <future>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "rr/async.hpp"
#include "runtime/cpp/src/node/testing/pipe_boards.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using ::testing::ElementsAre;

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
  PipeBoards boards({}, options());
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

// What goes to all wakes each process once.
TEST_P(PipesInFormat, EndsOfOneNodeStandTogether) {
  PipeBoards boards({}, options());
  Node other(options());
  const std::string url = "rr+tcp://127.0.0.1:" + std::to_string(boards.port) + "/?service=board";
  std::vector<Client<PipeBoardStub>> clients;
  std::vector<PipeEndpoint<double>> ends;
  for (Node* node : {&boards.client, &other, &boards.client, &other}) {
    clients.push_back(node->connect<PipeBoardStub>(url));
    ends.push_back(clients.back()->numbers().connect());
  }
  std::map<std::uint32_t, NodeId> nodes;
  for (const ServiceClient& one : boards.service->clients()) nodes[one.endpoint] = one.node;
  std::vector<NodeId> order;
  for (const auto& served : boards.board->numbers().endpoints()) {
    order.push_back(nodes.at(served.client()));
  }
  EXPECT_THAT(order, ElementsAre(boards.client.id(), boards.client.id(), other.id(), other.id()));
  boards.board->numbers().send(7);
  for (auto& end : ends) EXPECT_EQ(end.receive_for(10s), 7);
}

TEST_P(PipesInFormat, PacketsMayBeAnyValue) {
  PipeBoards boards({}, options());
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
  PipeBoards boards({}, options());
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
  PipeBoards boards({}, options());
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
  PipeBoards boards;
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
  PipeBoards boards;
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
  PipeBoards boards;
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
  PipeBoards boards;
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
  PipeBoards boards;
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
  PipeBoards boards({}, options);
  auto board = boards.connect();
  auto end = board->numbers().connect();
  const auto subscription = end.on_packet([](double) { throw std::runtime_error("not this one"); });
  boards.board->numbers().send(1);
  ASSERT_TRUE(eventually([&] { return reports.size() == 1; }));
  EXPECT_THAT(reports.items().front(), ::testing::HasSubstr("not this one"));
  board->sync();
}

TEST(Pipes, PacketsCanBeAwaited) {
  PipeBoards boards;
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

TEST(Pipes, AReceiveThatEndsEarlyLeavesThePacket) {
  PipeBoards boards;
  auto board = boards.connect();
  auto end = board->numbers().connect();
  std::stop_source stop;
  auto stopped = end.async_receive(stopped_by(stop.get_token()), boost::asio::use_future);
  auto expired = end.async_receive(within(10ms), boost::asio::use_future);
  auto kept = end.async_receive(within(1000s), boost::asio::use_future);
  stop.request_stop();
  EXPECT_EQ(error_of([&] { stopped.get(); }).code(), ErrorCode::operation_cancelled);
  EXPECT_EQ(error_of([&] { expired.get(); }).code(), ErrorCode::request_timeout);
  auto late = end.async_receive(stopped_by(stop.get_token()), boost::asio::use_future);
  EXPECT_EQ(error_of([&] { late.get(); }).code(), ErrorCode::operation_cancelled);
  boards.board->numbers().send(1);
  EXPECT_EQ(kept.get(), 1);
}

TEST(Pipes, AValueThatMayNotTravelTakesNoNumber) {
  NodeOptions small;
  small.limits.message_size = 100'000;
  PipeBoards boards({}, small);
  auto board = boards.connect();
  auto end = board->blobs().connect();
  EXPECT_EQ(error_of([&] { end.send(Array<std::uint8_t>(200'000)); }).code(),
            ErrorCode::protocol_error);
  EXPECT_EQ(end.send(Array<std::uint8_t>{1}), 1U);
  board->sync();
  EXPECT_EQ(boards.board->blobs().endpoints().front().receive(), Array<std::uint8_t>{1});
}

TEST(Pipes, AnAnswerComesBehindThePacketsThatWereSentBefore) {
  PipeBoards boards;
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
  PipeBoards boards;
  auto board = boards.connect();
  auto end = board->numbers().connect();
  for (int round = 0; round < 20; ++round) {
    for (int i = 0; i < 50; ++i) boards.board->numbers().send(i);
    for (int i = 0; i < 50; ++i) ASSERT_EQ(end.receive_for(10s), i);
  }
}

}  // namespace
}  // namespace rr::testing
