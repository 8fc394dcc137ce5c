// SPDX-License-Identifier: Apache-2.0
#include "rr/callbacks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/use_future.hpp>
#include <chrono>
#include <future>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

#include "rr/async.hpp"
#include "rr/call.hpp"
#include "runtime/cpp/src/node/testing/board.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::testing {
namespace {

using boost::asio::use_awaitable;
using boost::asio::use_future;
using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;

std::uint32_t caller() { return ServiceContext::current_client(); }

TEST(Callbacks, AreCalledFromInsideACallOfTheirClient) {
  BoardPair pair;
  Board& object = *pair.object;
  object.on_run = [&](const std::string& what) {
    if (what == "ping") {
      object.ping(caller());
      return 0;
    }
    return object.sum(caller(), 20, 22);
  };
  auto board = pair.connect();
  int pings = 0;
  board->ping().set([&] { ++pings; });
  board->sum().set([](std::int32_t a, std::int32_t b) { return a + b; });
  EXPECT_EQ(board->run("ping"), 0);
  EXPECT_EQ(pings, 1);
  EXPECT_EQ(board->run("sum"), 42);
}

TEST(Callbacks, CarryStructsAndLargeArrays) {
  BoardPair pair;
  auto board = pair.connect();
  board->describe().set([](const std::string& text, const Array<double>& numbers) {
    return text.empty() ? std::nullopt : std::optional(Note{text + "!", numbers});
  });
  Array<double> numbers(200'000);
  numbers.mutate()[7] = 0.5;
  const auto note = pair.object->describe(pair.only_client(), "large", numbers);
  ASSERT_TRUE(note);
  EXPECT_EQ(*note, (Note{"large!", numbers}));
  EXPECT_EQ(pair.object->describe(pair.only_client(), "", {}), std::nullopt);
}

TEST(Callbacks, SayWhatIsMissing) {
  BoardPair pair;
  auto board = pair.connect();
  const std::uint32_t client = pair.only_client();
  const Error unset = error_of([&] { pair.object->ping(client); });
  EXPECT_EQ(unset.code(), ErrorCode::invalid_operation);
  EXPECT_EQ(unset.message(), "Callback function not set");
  EXPECT_EQ(code_of([&] { pair.object->stray(client); }), ErrorCode::member_not_found);
  EXPECT_EQ(code_of([&] { pair.object->ping(client + 1); }), ErrorCode::connection_error);
  EXPECT_EQ(code_of([&] { pair.object->ping(0); }), ErrorCode::connection_error);
  EXPECT_EQ(code_of([&] { Board().ping(client); }), ErrorCode::connection_error);
}

class ChildKeeper final : public Board {
 public:
  std::shared_ptr<Skeleton> get_child() override { return child; }
  std::shared_ptr<Board> child = std::make_shared<Board>();
};

TEST(Callbacks, OfAnObjectThatTheClientDoesNotUseFail) {
  BoardPair pair;
  const auto parent = std::make_shared<ChildKeeper>();
  auto service = pair.server.register_service("parent", parent);
  auto board = pair.client.connect<BoardStub>("rr+tcp://127.0.0.1:" + std::to_string(pair.port) +
                                              "/?service=parent");
  const std::uint32_t client = service->clients().at(0).endpoint;
  auto stub = board->get_child();
  stub->ping().set([] {});
  parent->child->ping(client);
  EXPECT_EQ(code_of([&] { parent->ping(client); }), ErrorCode::invalid_operation);
  stub.reset();  // its functions go with it
  EXPECT_EQ(code_of([&] { parent->child->ping(client); }), ErrorCode::service_error);
}

TEST(Callbacks, ThrowAtTheServiceWhatTheClientThrows) {
  BoardPair pair;
  auto board = pair.connect();
  const std::uint32_t client = pair.only_client();
  board->fail().set([](const std::string& text) -> double {
    if (text == "jam") throw Jam("stuck", "deep", Array<double>{0.5});
    if (text == "code") throw Error(ErrorCode::out_of_range, "too far");
    throw std::runtime_error("broken");
  });
  try {
    pair.object->fail(client, "jam");
    FAIL() << "nothing was thrown";
  } catch (const Jam& jam) {
    EXPECT_EQ(jam.message(), "stuck");
    EXPECT_EQ(jam.subname(), "deep");
    EXPECT_EQ(jam.parameter(), VarValue(Array<double>{0.5}));
  }
  EXPECT_EQ(code_of([&] { pair.object->fail(client, "code"); }), ErrorCode::out_of_range);
  const Error unknown = error_of([&] { pair.object->fail(client, ""); });
  EXPECT_EQ(unknown.code(), ErrorCode::remote_error);
  EXPECT_EQ(unknown.message(), "broken");
}

TEST(Callbacks, ThatThrowReachTheCallThatCausedThem) {
  BoardPair pair;
  pair.object->on_run = [&](const std::string& what) { return pair.object->fail(caller(), what); };
  auto board = pair.connect();
  board->fail().set([](const std::string& text) -> double { throw Jam(text); });
  EXPECT_THROW(board->run("round"), Jam);
}

TEST(Callbacks, MayCallTheServiceThatCallsBackAgain) {
  BoardPair pair;
  Board& object = *pair.object;
  object.on_run = [&](const std::string& what) { return object.fail(caller(), what) + 1; };
  auto board = pair.connect();
  board->fail().set(
      [&](const std::string& text) { return text.size() < 8 ? board->run(text + "x") : 0; });
  EXPECT_EQ(board->run(""), 9);
}

TEST(Callbacks, ComeThroughWhileAnEventHandlerWaitsForACall) {
  std::promise<double> result;
  BoardPair pair;
  Board& object = *pair.object;
  object.on_run = [&](const std::string& what) {
    if (what == "fire") {
      object.note_down("now");
      return 0;
    }
    return object.sum(caller(), 1, 2);
  };
  auto board = pair.connect();
  board->sum().set([](std::int32_t a, std::int32_t b) { return a + b; });
  auto subscription =
      board->note_down().connect([&](const std::string&) { result.set_value(board->run("sum")); });
  board->run("fire");
  EXPECT_EQ(result.get_future().get(), 3);
}

TEST(Callbacks, ThatAreSlowHoldUpNeitherEventsNorCalls) {
  std::promise<void> entered;
  std::promise<void> gate;
  BoardPair pair;
  auto board = pair.connect();
  board->ping().set([&] {
    entered.set_value();
    gate.get_future().wait();
  });
  std::atomic<int> notes{0};
  auto subscription = board->note_down().connect([&](const std::string&) { ++notes; });
  std::thread asking([&, client = pair.only_client()] { pair.object->ping(client); });
  entered.get_future().wait();
  pair.object->note_down("a");
  pair.object->note_down("b");
  EXPECT_TRUE(eventually([&] { return notes == 2; }));
  EXPECT_EQ(board->run("x"), 0);
  gate.set_value();
  asking.join();
}

TEST(Callbacks, AreCalledFromManyThreadsAtOnce) {
  BoardPair pair;
  auto board = pair.connect();
  board->sum().set([](std::int32_t a, std::int32_t b) { return a + b; });
  const std::uint32_t client = pair.only_client();
  std::atomic<int> right{0};
  std::vector<std::thread> threads;
  for (std::int32_t t = 0; t < 8; ++t) {
    threads.emplace_back([&, t] {
      for (std::int32_t i = 0; i < 100; ++i) {
        if (pair.object->sum(client, t, i) == t + i) ++right;
      }
    });
  }
  for (int i = 0; i < 200; ++i) board->run("x");
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(right, 800);
}

TEST(Callbacks, OfManyCallsOfOneClientAtOnceAllReturn) {
  BoardPair pair;
  Board& object = *pair.object;
  object.on_run = [&](const std::string&) { return object.sum(caller(), 3, 4); };
  auto board = pair.connect();
  board->sum().set([&](std::int32_t a, std::int32_t b) {
    std::this_thread::sleep_for(1ms);
    return a + b;
  });
  std::vector<std::future<double>> calls;
  for (int i = 0; i < 100; ++i) calls.push_back(board->async_run("x", use_future));
  for (auto& call : calls) EXPECT_EQ(call.get(), 7);
}

TEST(Callbacks, ReachTheClientThatIsMeant) {
  BoardPair pair;
  Board& object = *pair.object;
  object.on_run = [&](const std::string&) { return object.sum(caller(), 0, 0); };
  std::vector<Client<BoardStub>> boards;
  for (std::int32_t i = 0; i < 5; ++i) {
    boards.push_back(pair.connect());
    boards.back()->sum().set([i](std::int32_t, std::int32_t) { return i; });
  }
  for (std::size_t i = 0; i < boards.size(); ++i) {
    EXPECT_EQ(boards[i]->run("who"), static_cast<double>(i));
  }
}

TEST(Callbacks, MayAskOtherClientsThatCallTheServiceMeanwhile) {
  BoardPair pair;
  Board& object = *pair.object;
  auto first = pair.connect();
  auto second = pair.connect();
  const auto clients = pair.service->clients();
  object.on_run = [&](const std::string& what) {
    if (what == "there") return object.fail(clients[1].endpoint, "back");
    if (what == "back") return object.fail(clients[0].endpoint, "home");
    return 5.0;
  };
  first->fail().set([&](const std::string& text) { return first->run(text); });
  second->fail().set([&](const std::string& text) { return second->run(text); });
  EXPECT_EQ(first->run("there"), 5);
}

TEST(Callbacks, WithoutAnAnswerInTimeFailAndTheNextOneWorks) {
  BoardPair pair;
  auto board = pair.connect();
  const std::uint32_t client = pair.only_client();
  board->sum().set([](std::int32_t a, std::int32_t) {
    if (a == 1) std::this_thread::sleep_for(200ms);
    return a;
  });
  const auto before = std::chrono::steady_clock::now();
  with_options(within(40ms), [&] {
    EXPECT_EQ(code_of([&] { pair.object->sum(client, 1, 0); }), ErrorCode::request_timeout);
    EXPECT_LT(std::chrono::steady_clock::now() - before, 190ms);
  });
  EXPECT_EQ(pair.object->sum(client, 2, 0), 2);
}

TEST(Callbacks, WaitAsLongAsTheNodeSays) {
  NodeOptions options;
  options.request_timeout = 50ms;
  BoardPair pair(options);
  auto board = pair.connect();
  board->ping().set([] { std::this_thread::sleep_for(200ms); });
  pair.object->on_run = [&](const std::string&) -> double {
    pair.object->ping(caller());
    return 0;
  };
  EXPECT_EQ(code_of([&] { board->run("x"); }), ErrorCode::request_timeout);
}

TEST(Callbacks, CanBeCancelled) {
  std::promise<void> entered;
  std::promise<void> gate;
  BoardPair pair;
  auto board = pair.connect();
  board->ping().set([&] {
    entered.set_value();
    gate.get_future().wait();
  });
  std::stop_source stop;
  std::thread canceller([&] {
    entered.get_future().wait();
    stop.request_stop();
  });
  with_options(within(10s, stop.get_token()), [&] {
    EXPECT_EQ(code_of([&] { pair.object->ping(pair.only_client()); }),
              ErrorCode::operation_cancelled);
  });
  gate.set_value();
  canceller.join();
}

TEST(Callbacks, FailWhenTheirClientLeaves) {
  std::promise<ErrorCode> code;
  std::promise<void> entered;
  std::promise<void> is_left;  // until then, the function gives no answer that might come first
  std::promise<void> gate;
  BoardPair pair;  // the function may still end while the pair does
  pair.object->on_run = [&](const std::string&) -> double {
    code.set_value(code_of([&] { pair.object->ping(caller()); }));
    is_left.get_future().wait();
    return 0;
  };
  std::optional<Client<BoardStub>> board = pair.connect();
  (*board)->ping().set([&, opened = gate.get_future().share()] {
    entered.set_value();
    opened.wait();
  });
  auto call = (*board)->async_run("x", use_future);
  entered.get_future().wait();
  std::thread leaving([&] { board->close(); });
  EXPECT_EQ(code.get_future().get(), ErrorCode::connection_error);
  gate.set_value();
  EXPECT_EQ(code_of([&] { call.get(); }), ErrorCode::connection_error);
  is_left.set_value();
  leaving.join();
  EXPECT_TRUE(eventually([&] { return pair.service->clients().empty(); }));
}

TEST(Callbacks, FailWhenTheServiceSendsTheClientAway) {
  std::promise<void> entered;
  std::promise<void> gate;
  BoardPair pair;
  auto board = pair.connect();
  const std::uint32_t client = pair.only_client();
  board->ping().set([&] {
    entered.set_value();
    gate.get_future().wait();
  });
  std::thread sender([&] {
    entered.get_future().wait();
    pair.service->disconnect(client);
  });
  EXPECT_EQ(code_of([&] { pair.object->ping(client); }), ErrorCode::connection_error);
  gate.set_value();
  sender.join();
}

TEST(Callbacks, InFlightEndWhenTheServersNodeShutsDown) {
  std::promise<ErrorCode> code;
  std::promise<void> entered;
  std::promise<void> gate;
  BoardPair pair;
  pair.object->on_run = [&](const std::string&) -> double {
    code.set_value(code_of([&] { pair.object->ping(caller()); }));
    return 0;
  };
  auto board = pair.connect();
  board->ping().set([&] {
    entered.set_value();
    gate.get_future().wait();
  });
  auto call = board->async_run("x", use_future);
  entered.get_future().wait();
  pair.server.shutdown();
  EXPECT_EQ(code.get_future().get(), ErrorCode::connection_error);
  gate.set_value();
  // Its handler has ended by then, and may have answered before the connection was closed.
  EXPECT_THAT(code_of([&] { call.get(); }),
              ::testing::AnyOf(ErrorCode::none, ErrorCode::connection_error));
}

TEST(Callbacks, InFlightEndWhenTheClientsNodeShutsDown) {
  std::promise<ErrorCode> code;
  std::promise<void> entered;
  std::promise<void> gate;
  BoardPair pair;
  auto board = pair.connect();
  board->ping().set([&] {
    code.set_value(code_of([&] { board->run("slow"); }));  // is open when the node goes
  });
  pair.object->on_run = [&](const std::string&) -> double {
    entered.set_value();
    gate.get_future().wait();
    return 0;
  };
  auto asking = pair.object->async_ping(pair.only_client(), use_future);
  entered.get_future().wait();
  pair.client.shutdown();
  EXPECT_EQ(code.get_future().get(), ErrorCode::connection_error);
  EXPECT_EQ(code_of([&] { asking.get(); }), ErrorCode::connection_error);
  gate.set_value();
}

TEST(Callbacks, AreNotCalledAnyMoreOnceCleared) {
  std::promise<void> entered;
  BoardPair pair;
  auto board = pair.connect();
  const std::uint32_t client = pair.only_client();
  std::atomic<bool> is_over{false};
  board->ping().set([&] {
    entered.set_value();
    std::this_thread::sleep_for(50ms);
    is_over = true;
  });
  std::thread asking([&] { pair.object->ping(client); });
  entered.get_future().wait();
  board->ping().clear();
  EXPECT_TRUE(is_over);
  EXPECT_EQ(code_of([&] { pair.object->ping(client); }), ErrorCode::invalid_operation);
  asking.join();
  board->ping().set([] {});
  pair.object->ping(client);
}

TEST(Callbacks, MayClearAndReplaceThemselves) {
  BoardPair pair;
  auto board = pair.connect();
  const std::uint32_t client = pair.only_client();
  board->sum().set([&](std::int32_t, std::int32_t) {
    board->sum().set([&](std::int32_t, std::int32_t) {
      board->sum().clear();
      return 2;
    });
    return 1;
  });
  EXPECT_EQ(pair.object->sum(client, 0, 0), 1);
  EXPECT_EQ(pair.object->sum(client, 0, 0), 2);
  EXPECT_EQ(code_of([&] { pair.object->sum(client, 0, 0); }), ErrorCode::invalid_operation);
}

TEST(Callbacks, LetGoOfWhatTheyHold) {
  BoardPair pair;
  auto held = std::make_shared<int>();
  const std::weak_ptr<int> watch = held;
  auto board = pair.connect();
  board->ping().set([held] {});
  board->sum().set([held](std::int32_t, std::int32_t) { return 0; });
  held.reset();
  board->ping().set([] {});
  EXPECT_FALSE(watch.expired());
  const auto stub = board.stub();
  board.close();
  EXPECT_TRUE(eventually([&] { return watch.expired(); }));
}

TEST(AsyncCallbacks, CompleteWithAnyToken) {
  BoardPair pair;
  auto board = pair.connect();
  const std::uint32_t client = pair.only_client();
  board->sum().set([](std::int32_t a, std::int32_t b) {
    if (a == 0) throw Jam("zero");
    return a + b;
  });
  EXPECT_EQ(pair.object->async_sum(client, 1, 2, use_future).get(), 3);
  auto failed = pair.object->async_sum(client, 0, 2, use_future);
  EXPECT_THROW(failed.get(), Jam);
  auto unset = pair.object->async_ping(client, use_future);
  EXPECT_EQ(code_of([&] { unset.get(); }), ErrorCode::invalid_operation);
  boost::asio::io_context context;
  auto sum = boost::asio::co_spawn(
      context,
      [&]() -> boost::asio::awaitable<std::int32_t> {
        co_return co_await pair.object->async_sum(client, 4, 5, use_awaitable);
      },
      use_future);
  context.run();
  EXPECT_EQ(sum.get(), 9);
}

TEST(AsyncCallbacks, FailInTimeAndWhenTheClientHasGone) {
  BoardPair pair;
  auto board = pair.connect();
  const std::uint32_t client = pair.only_client();
  board->ping().set([] { std::this_thread::sleep_for(150ms); });
  auto late = pair.object->async_ping(client, within(30ms), use_future);
  EXPECT_EQ(code_of([&] { late.get(); }), ErrorCode::request_timeout);
  auto open = pair.object->async_ping(client, use_future);
  board.close();
  EXPECT_EQ(code_of([&] { open.get(); }), ErrorCode::connection_error);
}

}  // namespace
}  // namespace rr::testing
