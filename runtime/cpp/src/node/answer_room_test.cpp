// SPDX-License-Identifier: Apache-2.0
// What handlers make before they answer counts before they make it (docs/reference/limits.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "rr/node.hpp"
#include "runtime/cpp/src/node/testing/counter.hpp"
#include "runtime/cpp/src/node/testing/gate.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/raw_client.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;

constexpr std::uint32_t size = 8 * 1024 * 1024;

// Counts how many of its handlers have a large array at the same time.
class Camera : public Counter {
 public:
  Array<std::uint8_t> blob(std::uint32_t bytes) override {
    ++asked;
    Array<std::uint8_t> picture(std::size_t{bytes});
    const int now = ++inside;
    {
      const std::lock_guard lock(mutex);
      most = std::max(most, now);
    }
    if (is_gated) {
      gate.pass();
    } else {
      std::this_thread::sleep_for(20ms);
    }
    --inside;
    return picture;
  }

  Gate gate;
  std::atomic<bool> is_gated{false};
  std::atomic<int> asked{0};
  std::atomic<int> inside{0};
  std::mutex mutex;
  int most = 0;
};

// By TCP whatever the channel of the test run: what is in the process has no account.
struct Studio {
  // Whoever has to be served in the end waits as long as a busy machine may need.
  explicit Studio(NodeOptions options = {.budget = {.patience = 60s}})
      : pair(std::move(options), {}, camera) {}
  Client<CounterStub> connect() {
    return pair.client.connect<CounterStub>("rr+tcp://127.0.0.1:" + std::to_string(pair.port) +
                                            "/?service=counter");
  }
  std::vector<Client<CounterStub>> connect(int count) {
    std::vector<Client<CounterStub>> clients;
    for (int i = 0; i < count; ++i) clients.push_back(connect());
    return clients;
  }

  std::shared_ptr<Camera> camera = std::make_shared<Camera>();
  Pair pair;
};

std::vector<std::future<std::size_t>> ask_all(std::vector<Client<CounterStub>>& clients) {
  std::vector<std::future<std::size_t>> calls;
  calls.reserve(clients.size());
  for (auto& client : clients) {
    calls.push_back(std::async(std::launch::async, [&] { return client->blob(size).size(); }));
  }
  return calls;
}

// The request, its text as a value, the answer, and what of it waits to be sent: no more than a
// node has for clients, so it may be all that one of them needs at a time.
TEST(AnswerRoom, TextsOfTheLargestMessagesAreSentBackToAClientThatIsAlone) {
  Studio studio;
  auto client = studio.connect();
  const std::string text(std::size_t{11} * 1024 * 1024, 'x');
  for (int i = 0; i < 5; ++i) EXPECT_EQ(client->echo(text), text);
}

TEST(AnswerRoom, LargeTextsOfSeveralClientsTakeTurns) {
  Studio studio;
  auto clients = studio.connect(6);
  const std::string text(std::size_t{6} * 1024 * 1024, 'x');
  std::vector<std::future<bool>> calls;
  for (auto& client : clients) {
    calls.push_back(std::async(std::launch::async, [&] {
      for (int i = 0; i < 3; ++i) {
        if (client->echo(text) != text) return false;
      }
      return true;
    }));
  }
  for (auto& call : calls) EXPECT_TRUE(call.get());
}

TEST(AnswerRoom, HandlersThatMakeLargeAnswersTakeTurnsWhereThereIsNoRoomForAll) {
  Studio studio;
  auto clients = studio.connect(12);
  EXPECT_EQ(clients[0]->blob(size).size(), size);  // how large they are is known from now on
  for (int round = 0; round < 3; ++round) {
    for (auto& call : ask_all(clients)) EXPECT_EQ(call.get(), size);
  }
  EXPECT_EQ(studio.camera->asked, 37);
  EXPECT_LE(studio.camera->most, 4);  // 39 MiB for all
  EXPECT_GE(studio.camera->most, 2);
}

// How large its answers are is not known before, and a client chooses.
TEST(AnswerRoom, CountsWhatHandlersMakeWhoseAnswersHaveBeenSmall) {
  Studio studio;
  auto clients = studio.connect(12);
  for (auto& client : clients) EXPECT_EQ(client->blob(10).size(), 10U);
  for (auto& call : ask_all(clients)) EXPECT_EQ(call.get(), size);
  EXPECT_LE(studio.camera->most, 4);
}

// An array that is freed in the handler does not count any more.
TEST(AnswerRoom, LeavesHandlersThatUseLargeArraysForAWhileAlone) {
  class Sums : public Camera {
   public:
    double add(double a, double b) override {
      for (int i = 0; i < 4; ++i) {
        const Array<std::uint8_t> used(std::size_t{size / 2});
        const Array<std::uint8_t> much(std::size_t{45} * 1024 * 1024);  // more than the pool has
        a += used[0] + much[0];
      }
      return a + b;
    }
  };
  Studio studio({.budget = {.patience = 50ms}});
  const Service service = studio.pair.server.register_service("sums", std::make_shared<Sums>());
  auto client = studio.pair.client.connect<CounterStub>(
      "rr+tcp://127.0.0.1:" + std::to_string(studio.pair.port) + "/?service=sums");
  auto other = studio.connect();
  studio.camera->is_gated = true;
  const OpenAtEnd open_at_end(studio.camera->gate);
  auto call = std::async(std::launch::async, [&] { return other->blob(size).size(); });
  ASSERT_TRUE(studio.camera->gate.has_entered());
  EXPECT_EQ(client->add(1, 2), 3);
  studio.camera->gate.open();
  EXPECT_EQ(call.get(), size);
}

TEST(AnswerRoom, AMemberIsNotAskedForAnAnswerThatFindsNoRoomInTime) {
  Studio studio({.budget = {.patience = 200ms}});
  auto clients = studio.connect(4);
  auto late = studio.connect();
  EXPECT_EQ(late->blob(size).size(), size);
  studio.camera->is_gated = true;
  const OpenAtEnd open_at_end(studio.camera->gate);
  auto calls = ask_all(clients);
  ASSERT_TRUE(studio.camera->gate.has_entered(4));
  const int asked = studio.camera->asked;
  EXPECT_EQ(code_of([&] { (void)late->blob(size); }), ErrorCode::out_of_system_resource);
  EXPECT_EQ(studio.camera->asked, asked);
  EXPECT_EQ(late->add(1, 2), 3);  // members with small answers are asked
  studio.camera->gate.open();
  for (auto& call : calls) EXPECT_EQ(call.get(), size);
  EXPECT_EQ(late->blob(size).size(), size);  // there is room again
}

TEST(AnswerRoom, IsGivenBackByHandlersThatThrow) {
  class Failing : public Camera {
   public:
    Array<std::uint8_t> blob(std::uint32_t bytes) override {
      if (is_broken) throw Error(ErrorCode::operation_failed, "no picture");
      return Camera::blob(bytes);
    }
    std::atomic<bool> is_broken{false};
  };
  Studio studio;
  const auto camera = std::make_shared<Failing>();
  const Service service = studio.pair.server.register_service("failing", camera);
  auto client = studio.pair.client.connect<CounterStub>(
      "rr+tcp://127.0.0.1:" + std::to_string(studio.pair.port) + "/?service=failing");
  EXPECT_EQ(client->blob(size).size(), size);
  camera->is_broken = true;
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(code_of([&] { (void)client->blob(size); }), ErrorCode::operation_failed);
  }
  camera->is_broken = false;
  EXPECT_EQ(client->blob(size).size(), size);
}

// So that others need not wait until a message with thousands of answers has been made.
TEST(AnswerRoom, ManyGatheredAnswersLeaveInSeveralMessages) {
  Node server;
  auto service = server.register_service("counter", std::make_shared<Counter>());
  RawClient client(server, "counter");
  std::vector<RawClient::Request> requests;
  for (std::uint32_t id = 1; id <= 600; ++id) {
    requests.push_back({EntryType::property_get_req, "counter", "value", nullptr, id});
  }
  client.send(requests);
  std::vector<std::size_t> sizes;
  std::uint32_t last = 0;
  while (last < requests.size()) {
    const std::vector<RawClient::Answer> answers = client.receive_all();
    ASSERT_FALSE(answers.empty());
    sizes.push_back(answers.size());
    for (const RawClient::Answer& answer : answers) EXPECT_EQ(answer.id, ++last);
  }
  EXPECT_EQ(sizes, (std::vector<std::size_t>{256, 256, 88}));
}

}  // namespace
}  // namespace rr::testing
