// SPDX-License-Identifier: Apache-2.0
// What code of the program throws, and how long it may be waited for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <boost/asio/use_future.hpp>
#include <chrono>
#include <future>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "rr/call.hpp"
#include "rr/callbacks.hpp"
#include "runtime/cpp/src/node/testing/async_counter.hpp"
#include "runtime/cpp/src/node/testing/board.hpp"
#include "runtime/cpp/src/node/testing/gate.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/pipe_boards.hpp"

namespace rr::testing {
namespace {

using boost::asio::use_future;
using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using ::testing::Contains;
using ::testing::HasSubstr;
using Clock = std::chrono::steady_clock;

struct Errors {
  std::mutex mutex;
  std::vector<std::string> lines;
  auto log() {
    return [this](LogLevel level, std::string_view text) {
      const std::lock_guard lock(mutex);
      if (level == LogLevel::error) lines.emplace_back(text);
    };
  }
  std::size_t count(const std::string& part) {
    const std::lock_guard lock(mutex);
    std::size_t found = 0;
    for (const std::string& line : lines) {
      if (line.find(part) != std::string::npos) ++found;
    }
    return found;
  }
};

constexpr int nothing_of_the_standard = 42;

TEST(UserCode, MayThrowAnythingInACompletion) {
  Errors errors;
  Pair pair({}, {.log = errors.log()});
  auto counter = pair.connect();
  counter->async_add(1, 2,
                     [](const std::exception_ptr&, double) { throw nothing_of_the_standard; });
  EXPECT_TRUE(eventually([&] { return errors.count("a completion handler has thrown") == 1; }));
  EXPECT_EQ(counter->add(1, 2), 3);
}

TEST(UserCode, MayThrowAnythingInAnEventHandler) {
  Errors errors;
  Pair pair({}, {.log = errors.log()});
  auto counter = pair.connect();
  const Subscription ticks = counter->ticked().connect(
      [](std::int32_t, const std::string&) { throw nothing_of_the_standard; });
  std::atomic<int> heard{0};
  const Subscription others =
      counter->ticked().connect([&](std::int32_t, const std::string&) { ++heard; });
  counter->fire(2);
  EXPECT_TRUE(eventually([&] { return heard == 2 && errors.count("`ticked`") == 2; }));
}

TEST(UserCode, MayThrowAnythingWhenASessionEnds) {
  Errors errors;
  Pair pair({}, {.log = errors.log()});
  ConnectOptions options;
  options.on_closed = [](const Error&) { throw nothing_of_the_standard; };
  auto counter = pair.connect(options);
  pair.service->disconnect(pair.service->clients().front().endpoint);
  EXPECT_TRUE(eventually([&] { return errors.count("an on_closed handler has thrown") == 1; }));
}

TEST(UserCode, MayThrowAnythingWhenClientsComeAndGo) {
  Errors errors;
  Pair pair(
      {.log = errors.log()}, {}, std::make_shared<Counter>(),
      {.on_client_connected = [](const ServiceClient&) { throw nothing_of_the_standard; },
       .on_client_disconnected = [](const ServiceClient&) { throw nothing_of_the_standard; }});
  EXPECT_EQ(pair.connect()->add(1, 2), 3);
  EXPECT_TRUE(eventually([&] { return errors.count("a listener of `counter`") == 2; }));
}

TEST(UserCode, MayThrowAnythingInAMember) {
  class Throwing : public Counter {
   public:
    void reset() override { throw nothing_of_the_standard; }
  };
  Pair pair({}, {}, std::make_shared<Throwing>());
  auto counter = pair.connect();
  EXPECT_NE(code_of([&] { counter->reset(); }), ErrorCode::none);
  EXPECT_EQ(counter->add(1, 2), 3);
}

TEST(UserCode, MayThrowAnythingAsideAndInTheLog) {
  std::atomic<int> lines{0};
  Node node({.log = [&](LogLevel, std::string_view) {
    ++lines;
    throw nothing_of_the_standard;
  }});
  node.run_aside([] { throw nothing_of_the_standard; });
  EXPECT_TRUE(eventually([&] { return lines == 1; }));
}

TEST(PipeWaits, OnePacketWakesAllThatWaitForOne) {
  PipeBoards boards;
  auto board = boards.connect();
  auto end = board->out().connect();
  std::atomic<int> begun{0};
  std::vector<std::future<bool>> waits;
  for (int i = 0; i < 2; ++i) {
    waits.push_back(std::async(std::launch::async, [&] {
      ++begun;
      return end.wait(20s);
    }));
  }
  EXPECT_TRUE(eventually([&] { return begun == 2; }));
  std::this_thread::sleep_for(100ms);
  const auto begin = Clock::now();
  boards.board->out().endpoints().at(0).send(1);
  for (auto& wait : waits) EXPECT_TRUE(wait.get());
  EXPECT_LT(Clock::now() - begin, 10s);
}

TEST(Generators, WithoutATimeLimitAreNotDropped) {
  NodeOptions options;
  options.generator_timeout = std::chrono::milliseconds::max();
  options.client_timeout = 200ms;  // brings the looks at generators close together
  BoardPair pair(options, {.keep_alive_period = 50ms});
  auto board = pair.connect();
  auto counter = board->count_to(3);
  EXPECT_EQ(counter.next(), 1);
  std::this_thread::sleep_for(400ms);
  EXPECT_EQ(counter.next(), 2);
}

// The client does something slow before it answers, which the service handles meanwhile.
TEST(Callbacks, EndInTimeThoughTheirClientsNextRequestIsSlow) {
  std::promise<Clock::duration> waited;
  Gate gate;  // threads of the node may still be in there when it ends
  BoardPair pair;
  pair.object->on_run = [&](const std::string& what) -> double {
    if (what == "slow") {
      gate.pass();
      return 0;
    }
    const auto begin = Clock::now();
    const auto client = ServiceContext::current_client();
    with_options(within(200ms), [&] {
      EXPECT_EQ(code_of([&] { pair.object->sum(client, 1, 2); }), ErrorCode::request_timeout);
    });
    waited.set_value(Clock::now() - begin);
    return 7;
  };
  auto board = pair.connect();
  board->sum().set([&](std::int32_t, std::int32_t) {
    board->run("slow");
    return 3;
  });
  auto asked = board->async_run("ask", use_future);
  auto time = waited.get_future();
  ASSERT_EQ(time.wait_for(20s), std::future_status::ready);
  EXPECT_LT(time.get(), 10s);
  EXPECT_EQ(asked.wait_for(20s), std::future_status::ready);  // answered beside the slow one
  gate.open();
  EXPECT_EQ(asked.get(), 7);
  EXPECT_EQ(board->run("slow"), 0);  // one at a time again
}

TEST(Objects, ThatAreLookedForByOneClientAreWaitedForInTime) {
  class Gated : public Counter {
   public:
    std::shared_ptr<Skeleton> get_child() override {
      gate.pass();
      return std::make_shared<Counter>();
    }
    Gate gate;
  };
  const auto object = std::make_shared<Gated>();
  Pair pair({.request_timeout = 1s}, {.request_timeout = 20s}, object);
  auto one = pair.connect();
  auto other = pair.connect();
  auto first = std::async(std::launch::async, [&] { return code_of([&] { one->get_child(); }); });
  EXPECT_TRUE(object->gate.has_entered());
  EXPECT_NE(code_of([&] { other->get_child(); }), ErrorCode::none);
  EXPECT_EQ(other->add(1, 2), 3);
  object->gate.open();
  EXPECT_EQ(first.get(), ErrorCode::none);
  EXPECT_EQ(code_of([&] { other->get_child(); }), ErrorCode::none);
}

// The service asks the client whether it may have the object; the client uses it before it answers.
TEST(Objects, ThatAreLookedForByAskingTheirClientMayBeAskedForByItMeanwhile) {
  class Asking : public Board {
   public:
    std::shared_ptr<Skeleton> get_child() override {
      ++looks;
      const auto client = ServiceContext::current_client();
      const Error error = error_of([&] { sum(client, 1, 2); });
      return std::make_shared<Board>();
    }
    std::atomic<int> looks{0};
  };
  const auto object = std::make_shared<Asking>();
  Node server({.request_timeout = 5s});
  Node client;
  const Service service = server.register_service("board", object);
  const std::string url =
      "rr+tcp://127.0.0.1:" + std::to_string(server.listen_tcp(0, "127.0.0.1")) + "/?service=board";
  auto board = client.connect<BoardStub>(url);
  board->sum().set([&](std::int32_t, std::int32_t) {
    with_options(within(300ms), [&] { (void)error_of([&] { board->get_child(); }); });
    return 1;
  });
  EXPECT_EQ(code_of([&] { board->get_child(); }), ErrorCode::none);
  EXPECT_EQ(object->looks, 1);
  EXPECT_EQ(board->run("x"), 0);
  server.shutdown();
}

}  // namespace
}  // namespace rr::testing
