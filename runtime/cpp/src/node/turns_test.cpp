// SPDX-License-Identifier: Apache-2.0
// A client with much to say does not keep the polling thread from others.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <thread>
#include <vector>

#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/process_state.hpp"
#include "runtime/cpp/src/node/testing/raw_client.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using std::chrono_literals::operator""us;

// Whose `reset` takes its time until somebody has called `add`, and whose `add` notes how many of
// these have been made before.
class Patient : public Counter {
 public:
  void reset() override {
    ++resets;
    const auto end = std::chrono::steady_clock::now() + 2ms;
    while (added_after == 0 && std::chrono::steady_clock::now() < end) continue;
  }
  double add(double a, double b) override {
    int none = 0;
    added_after.compare_exchange_strong(none, resets);
    return a + b;
  }
  std::atomic<int> resets{0};
  std::atomic<int> added_after{0};
};

constexpr int resets = 2'000;

RawClient::Request reset_request(std::uint32_t id) {
  return {.type = EntryType::function_call_req, .path = "counter", .member = "reset", .id = id};
}

// No thread is left that could take over polling.
NodeOptions with_two_threads() { return {.max_threads = 2}; }

void expect_served_between(Pair& pair, const Patient& object, Client<CounterStub>& other) {
  ASSERT_TRUE(eventually([&] { return object.resets > 0; }));
  EXPECT_EQ(other->add(1, 2), 3);
  EXPECT_GT(object.added_after, 0);
  EXPECT_LT(object.added_after, resets);
  EXPECT_TRUE(eventually([&] { return object.resets == resets; }));
  EXPECT_EQ(pair.connect()->add(1, 2), 3);
}

TEST(Turns, OthersAreServedBetweenTheRequestsOfOneMessage) {
  const auto object = std::make_shared<Patient>();
  Pair pair(with_two_threads(), {.request_timeout = 60s}, object);
  auto other = pair.connect();
  RawClient busy(pair.server, "counter");
  std::vector<RawClient::Request> requests;
  for (std::uint32_t id = 1; id <= resets; ++id) requests.push_back(reset_request(id));
  busy.send(requests);
  expect_served_between(pair, *object, other);
  // The answers come as if nothing had been between: gathered, in their order.
  std::uint32_t last = 0;
  while (last < resets) {
    const std::vector<RawClient::Answer> answers = busy.receive_all();
    ASSERT_EQ(answers.size(), std::min<std::size_t>(256, resets - last));
    for (const RawClient::Answer& answer : answers) EXPECT_EQ(answer.id, ++last);
  }
}

TEST(Turns, OthersAreServedBetweenTheMessagesOfOneClient) {
  const auto object = std::make_shared<Patient>();
  Pair pair(with_two_threads(), {.request_timeout = 60s}, object);
  auto other = pair.connect();
  RawClient busy(pair.server, "counter");
  for (std::uint32_t id = 1; id <= resets; ++id) {
    const RawClient::Request request = reset_request(id);
    busy.send({&request, 1});
  }
  expect_served_between(pair, *object, other);
  for (std::uint32_t id = 1; id <= resets; ++id) {
    const auto answer = busy.receive();
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->id, id);
  }
}

// Whose `reset` takes its time, always; notes how many of these there were since a client has
// asked.
class Burdened : public Counter {
 public:
  void reset() override {
    ++resets;
    const auto end = std::chrono::steady_clock::now() + 100us;
    while (std::chrono::steady_clock::now() < end) continue;
  }
  double add(double asked_at, double b) override { return resets - asked_at + b; }
  std::atomic<int> resets{0};
};

// Those with much to say are often ready together. Another client waits for what one of them may do
// at a time, and for what ends before that is known; not for the turns of all.
TEST(Turns, AClientWithLittleToSayWaitsForOneOfMany) {
  constexpr int clients = 16;
  constexpr int trials = 40;
  const auto object = std::make_shared<Burdened>();
  Pair pair(with_two_threads(), {.request_timeout = 60s}, object);
  auto other = pair.connect();
  std::atomic<bool> is_over{false};
  std::vector<std::jthread> busy;
  for (int i = 0; i < clients; ++i) {
    busy.emplace_back([&] {
      RawClient client(pair.server, "counter");
      const std::vector<RawClient::Request> requests(3, reset_request(1));
      while (!is_over) {
        client.send(requests);
        client.receive_all();
      }
    });
  }
  ASSERT_TRUE(eventually([&] { return object->resets > 100; }));
  std::vector<double> waits;
  for (int i = 0; i < trials; ++i) waits.push_back(other->add(object->resets, 0));
  is_over = true;
  std::nth_element(waits.begin(), waits.begin() + trials / 2, waits.end());
  // The turns of all are three times as many requests; sanitizers make what is between them longer.
  EXPECT_LT(waits[trials / 2], slowness() == 1 ? clients : 2 * clients);
}

// A client that leaves in the middle of its message: the rest is not done.
TEST(Turns, TheRestOfAMessageEndsWithItsClient) {
  const auto object = std::make_shared<Patient>();
  Pair pair(with_two_threads(), {.request_timeout = 60s}, object);
  auto other = pair.connect();
  {
    RawClient busy(pair.server, "counter");
    std::vector<RawClient::Request> requests;
    for (std::uint32_t id = 1; id <= resets; ++id) requests.push_back(reset_request(id));
    busy.send(requests);
    ASSERT_TRUE(eventually([&] { return object->resets > 0; }));
  }
  ASSERT_TRUE(eventually([&] { return pair.service->clients().size() == 1; }));
  const int done = object->resets;
  EXPECT_LT(done, resets);
  EXPECT_EQ(other->add(1, 2), 3);
  EXPECT_EQ(object->resets, done);
}

}  // namespace
}  // namespace rr::testing
