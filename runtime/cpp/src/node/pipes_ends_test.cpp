// SPDX-License-Identifier: Apache-2.0
// How pipes between a service and its clients end.
#include <gtest/gtest.h>

#include <atomic>
#include <boost/asio/use_future.hpp>
#include <chrono>
#include <future>
#include <memory>
#include <vector>

#include "rr/async.hpp"
#include "rr/pipes.hpp"
#include "runtime/cpp/src/node/testing/gate.hpp"
#include "runtime/cpp/src/node/testing/pipe_boards.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;

TEST(Pipes, TheClientCloses) {
  std::atomic<int> closed{0};
  PipeBoards boards;
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
  PipeBoards boards;
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

TEST(Pipes, AnIndexMayComeBackBeforeItsEndIsTold) {
  Gate gate;
  PipeBoards boards;
  auto board = boards.connect();
  auto end = board->numbers().connect();
  ASSERT_EQ(end.index(), 1);
  // What comes now waits for this function; answers do not.
  const Subscription packets = end.on_packet([&](double /*number*/) { gate.pass(); });
  auto served = boards.board->numbers().endpoints().front();
  served.send(1);
  ASSERT_TRUE(gate.has_entered());
  served.close();
  auto next = board->numbers().connect({.index = 1});
  EXPECT_EQ(next.index(), 1);
  EXPECT_TRUE(next.is_open());
  gate.open();
  EXPECT_TRUE(eventually([&] { return !end.is_open(); }));
  boards.board->numbers().endpoints().front().send(2);
  EXPECT_EQ(next.receive_for(10s), 2);
  EXPECT_TRUE(next.is_open());
  EXPECT_FALSE(end.is_open());
}

TEST(Pipes, AFunctionThatHoldsItsPipeEndsWithTheObject) {
  std::weak_ptr<int> held;
  {
    PipeBoards boards;
    const auto token = std::make_shared<int>(0);
    held = token;
    const auto numbers = boards.board->numbers();
    numbers.on_connect([numbers, token](PipeEndpoint<double> end) {
      end.send(static_cast<double>(numbers.endpoint_count()));
    });
    auto board = boards.connect();
    EXPECT_EQ(board->numbers().connect().receive_for(10s), 1);
  }
  EXPECT_TRUE(held.expired());
}

TEST(Pipes, TheServiceMayRefuseAnEndpoint) {
  PipeBoards boards;
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
  auto future = board->numbers().async_connect({.index = 7}, boost::asio::use_future);
  EXPECT_THROW(future.get(), Error);
  EXPECT_EQ(boards.board->numbers().endpoint_count(), 0U);
  EXPECT_EQ(board->numbers().connect({.index = 9}).index(), 9);
}

TEST(Pipes, TheEndOfASessionEndsItsEndpoints) {
  std::atomic<int> closed{0};
  PipeBoards boards;
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
  PipeBoards boards;
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
  PipeBoards boards;
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

// The answer to connecting is read by who waits for it; the notice, which was sent before, waits
// for a function of the program.
TEST(Pipes, AnEndpointIsNotEndedByANoticeThatWasSentBefore) {
  Gate gate;
  PipeBoards boards;
  boards.board->child = std::make_shared<PipeBoard>();
  auto board = boards.connect();
  auto child = board->get_child();
  auto held = board->numbers().connect();
  const auto holding = held.on_packet([&](double) { gate.pass(); });
  boards.board->numbers().send(1);
  ASSERT_TRUE(gate.has_entered());
  boards.service->release_path("board.child");
  auto fresh = child->numbers().connect();
  ASSERT_EQ(boards.board->child->numbers().endpoint_count(), 1U);
  gate.open();
  std::atomic<bool> is_behind{false};
  const auto behind = held.on_packet([&](double number) { is_behind = number == 2; });
  boards.board->numbers().send(2);
  ASSERT_TRUE(eventually([&] { return is_behind.load(); }));
  EXPECT_TRUE(fresh.is_open());
  boards.board->child->numbers().send(7.5);
  EXPECT_EQ(fresh.receive_for(20s), 7.5);
  // A notice that comes later ends it as ever.
  boards.service->release_path("board.child");
  EXPECT_TRUE(eventually([&] { return !fresh.is_open(); }));
}

TEST(Pipes, EndpointsComeAndGoWhileOthersSend) {
  std::atomic<bool> is_over{false};
  PipeBoards boards;
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
  auto boards = std::make_unique<PipeBoards>();
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
