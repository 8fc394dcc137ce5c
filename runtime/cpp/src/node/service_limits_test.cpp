// SPDX-License-Identifier: Apache-2.0
// What clients may make a service do and keep.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <boost/asio/use_future.hpp>
#include <chrono>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "rr/async.hpp"
#include "rr/locks.hpp"
#include "rr/node.hpp"
#include "rr/users.hpp"
#include "runtime/cpp/src/node/testing/async_counter.hpp"
#include "runtime/cpp/src/node/testing/board.hpp"
#include "runtime/cpp/src/node/testing/gate.hpp"
#include "runtime/cpp/src/node/testing/gated_counter.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/raw_client.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""ms;

constexpr std::size_t mib = 1024 * 1024;
const auto too_much = static_cast<std::uint16_t>(ErrorCode::out_of_system_resource);

RawClient::Elements size_of_blob(std::uint32_t size) {
  return [size](Writer& writer) {
    type_of<std::uint32_t>.write(writer, "size", &size);
    return 1U;
  };
}

// Special requests

TEST(SpecialRequests, TravelAlone) {
  Pair pair;
  RawClient client(pair.server, "counter");
  std::vector<RawClient::Request> requests(3, {EntryType::get_service_desc, "counter", ""});
  for (std::uint32_t i = 0; i < 3; ++i) requests[i].id = 20 + i;
  client.send(requests);
  const auto answers = client.receive_all();
  ASSERT_EQ(answers.size(), 3U);
  EXPECT_EQ(answers[0].error, 0);
  EXPECT_GT(answers[0].element_count, 0U);
  for (std::uint32_t i = 1; i < 3; ++i) {
    EXPECT_EQ(answers[i].type, EntryType::get_service_desc_ret);
    EXPECT_EQ(answers[i].id, 20 + i);
    EXPECT_EQ(answers[i].error, static_cast<std::uint16_t>(ErrorCode::protocol_error));
  }
}

TEST(SpecialRequests, ManyInOneMessageEndTheConnection) {
  Pair pair;
  RawClient client(pair.server, "counter");
  const std::vector<RawClient::Request> requests(20'000, {EntryType::get_service_desc, "c", ""});
  client.send(requests);
  EXPECT_TRUE(client.receive_all().empty());
  EXPECT_TRUE(eventually([&] { return pair.service->clients().empty(); }));
}

// Several requests in one message

// Keeps the answers to `slow` until the test gives them, and counts what it is asked.
class LateCounter : public Counter {
 public:
  void slow(Reply<void> reply, std::int32_t) override {
    const std::lock_guard lock(mutex);
    replies.push_back(std::move(reply));
  }
  Array<std::uint8_t> blob(std::uint32_t size) override {
    ++blobs;
    return Array<std::uint8_t>(std::size_t{size});
  }
  void reset() override { ++resets; }
  std::size_t owed() {
    const std::lock_guard lock(mutex);
    return replies.size();
  }
  void answer_all() {
    const std::lock_guard lock(mutex);
    for (auto& reply : replies) reply();
    replies.clear();
  }

  std::mutex mutex;
  std::vector<Reply<void>> replies;
  std::atomic<int> blobs{0};
  std::atomic<int> resets{0};
};

RawClient::Request slow_request() {
  return {EntryType::function_call_req, "counter", "slow", [](Writer& writer) {
            const std::int32_t time = 0;
            type_of<std::int32_t>.write(writer, "milliseconds", &time);
            return 1U;
          }};
}

TEST(GatheredAnswers, LeaveInOrderAsSoonAsTheyFillAMessage) {
  auto counter = std::make_shared<LateCounter>();
  NodeOptions options;
  options.limits.message_size = 1 * mib;
  Pair pair(options, {}, counter);
  RawClient client(pair.server, "counter");
  std::vector<RawClient::Request> requests;
  for (std::uint32_t i = 0; i < 6; ++i) {
    requests.push_back(
        {EntryType::function_call_req, "counter", "blob", size_of_blob(400'000), 100 + i});
  }
  requests.push_back(slow_request());
  requests.back().id = 106;
  client.send(requests);
  std::vector<std::uint32_t> ids;
  std::vector<std::size_t> sizes;
  const auto take = [&] {
    const auto answers = client.receive_all();
    sizes.push_back(answers.size());
    for (const auto& answer : answers) {
      EXPECT_EQ(answer.error, 0);
      ids.push_back(answer.id);
    }
  };
  // The last answer is owed still.
  take();
  take();
  ASSERT_TRUE(eventually([&] { return counter->owed() == 1; }));
  counter->answer_all();
  take();
  if (ids.size() < 7) take();
  EXPECT_EQ(ids, (std::vector<std::uint32_t>{100, 101, 102, 103, 104, 105, 106}));
  EXPECT_EQ(sizes[0], 2U);
  EXPECT_EQ(sizes[1], 2U);
}

TEST(GatheredAnswers, ThatWaitAreRefusedBeyondWhatTheClientMayHold) {
  auto counter = std::make_shared<LateCounter>();
  NodeOptions options;
  options.limits.message_size = 2 * mib;
  options.budget = {.before_session = 6 * mib, .sessions = 6 * mib};  // one client gets 4 of it
  Pair pair(options, {}, counter);
  RawClient client(pair.server, "counter");
  std::vector<RawClient::Request> requests{slow_request()};
  for (std::uint32_t i = 1; i <= 12; ++i) {
    requests.push_back({EntryType::function_call_req, "counter", "blob", size_of_blob(1 * mib), i});
  }
  requests.push_back({EntryType::function_call_req, "counter", "reset"});
  client.send(requests);
  ASSERT_TRUE(eventually([&] { return counter->resets == 1; }));
  EXPECT_LE(counter->blobs, 4);  // the others would have been made in vain
  counter->answer_all();
  std::size_t served = 0;
  std::size_t refused = 0;
  while (served + refused < 14) {
    const auto answers = client.receive_all();
    ASSERT_FALSE(answers.empty());
    for (const auto& answer : answers) {
      ++(answer.error == 0 ? served : refused);
      if (answer.error != 0) {
        EXPECT_EQ(answer.error, too_much);
      }
    }
  }
  EXPECT_GE(served, 3U);
  EXPECT_GE(refused, 8U);
  // What was held has been given back.
  client.send(EntryType::function_call_req, "counter", "blob", size_of_blob(1 * mib));
  const auto answer = client.receive();
  ASSERT_TRUE(answer.has_value());
  EXPECT_EQ(answer->error, 0);
}

TEST(GatheredAnswers, StopWhenTheClientHasLeft) {
  class Counting : public GatedCounter {
   public:
    void reset() override {
      ++resets;
      GatedCounter::reset();
    }
    std::atomic<int> resets{0};
  };
  auto counter = std::make_shared<Counting>();
  Pair pair({}, {}, counter);
  {
    RawClient client(pair.server, "counter");
    client.send(
        std::vector<RawClient::Request>(100, {EntryType::function_call_req, "counter", "reset"}));
    ASSERT_TRUE(counter->gate.has_entered());
  }
  std::this_thread::sleep_for(500ms);  // until the end of the connection has been read
  counter->gate.open();
  EXPECT_TRUE(eventually([&] { return pair.service->clients().empty(); }));
  EXPECT_EQ(counter->resets, 1);
}

// Counts

TEST(ServiceLimits, TheGeneratorsOfASessionAreCounted) {
  Node server;
  Node client;
  auto board = std::make_shared<Board>();
  ServiceOptions options;
  options.limits.generators = 3;
  server.register_service("board", board, options);
  const std::string url =
      "rr+tcp://127.0.0.1:" + std::to_string(server.listen_tcp(0, "127.0.0.1")) + "/?service=board";
  auto first = client.connect<BoardStub>(url);
  std::vector<Generator<std::int32_t>> open;
  for (int i = 0; i < 3; ++i) open.push_back(first->count_to(1));
  const Error error = error_of([&] { first->count_to(1); });
  EXPECT_EQ(error.code(), ErrorCode::out_of_system_resource);
  EXPECT_THAT(error.message(), ::testing::HasSubstr("3 generators"));
  auto second = client.connect<BoardStub>(url);
  EXPECT_EQ(second->count_to(1).next(), 1);  // each session has its own
  while (open[0].next()) {
  }
  EXPECT_NO_THROW(first->count_to(1));  // what has ended does not count
}

// For a while a service knows the last of them.
TEST(ServiceLimits, GeneratorsThatAreClosedDoNotCount) {
  Node server;
  Node client;
  ServiceOptions options;
  options.limits.generators = 2;
  server.register_service("board", std::make_shared<Board>(), options);
  auto board = client.connect<BoardStub>(
      "rr+tcp://127.0.0.1:" + std::to_string(server.listen_tcp(0, "127.0.0.1")) +
      "/?service=board");
  auto open = board->count_to(2);
  EXPECT_EQ(open.next(), 1);
  for (int i = 0; i < 1000; ++i) {
    auto counter = board->count_to(10);
    EXPECT_EQ(counter.next(), 1);
    if (i % 2 == 0) {
      counter.close();
      EXPECT_EQ(counter.next(), std::nullopt);
    } else {
      counter.abort();
      EXPECT_EQ(code_of([&] { counter.next(); }), ErrorCode::operation_aborted);
    }
  }
  std::vector<Generator<std::int32_t>> closed;
  for (int i = 0; i < 1000; ++i) {
    closed.push_back(board->count_to(1));
    closed.back().close();
  }
  EXPECT_EQ(code_of([&] { closed.front().next(); }), ErrorCode::invalid_operation);
  EXPECT_EQ(closed.back().next(), std::nullopt);
  EXPECT_EQ(open.next(), 2);
}

TEST(ServiceLimits, TheAnswersThatAServiceOwesASessionAreCounted) {
  auto counter = std::make_shared<LateCounter>();
  ServiceOptions options;
  options.limits.late_answers = 2;
  Pair pair({}, {}, counter, options);
  auto client = pair.connect();
  std::vector<std::future<void>> calls;
  for (int i = 0; i < 2; ++i) calls.push_back(client->async_slow(0, boost::asio::use_future));
  ASSERT_TRUE(eventually([&] { return counter->owed() == 2; }));
  EXPECT_EQ(code_of([&] { client->slow(0); }), ErrorCode::out_of_system_resource);
  counter->answer_all();
  for (auto& call : calls) EXPECT_NO_THROW(call.get());
  auto next = client->async_slow(0, boost::asio::use_future);
  ASSERT_TRUE(eventually([&] { return counter->owed() == 1; }));
  counter->answer_all();
  EXPECT_NO_THROW(next.get());
}

TEST(ServiceLimits, AnswersOwedToClientsThatHaveLeftTakeNothingFromOthers) {
  NodeOptions small;
  small.limits.message_size = 2 * mib;
  small.budget.sessions = 6 * mib;
  auto counter = std::make_shared<LateCounter>();
  Pair pair(small, {}, counter);
  for (std::size_t i = 1; i <= 400; ++i) {
    auto client = pair.connect();
    auto call = client->async_slow(0, boost::asio::use_future);
    ASSERT_TRUE(eventually([&] { return counter->owed() == i; }));
    client.close();
  }
  EXPECT_EQ(pair.connect()->blob(std::uint32_t{mib}).size(), mib);
  EXPECT_NO_THROW(counter->answer_all());
}

TEST(ServiceLimits, TheCallbacksThatAClientOwesAreCounted) {
  Node server;
  Node client;
  auto board = std::make_shared<Board>();
  ServiceOptions options;
  options.limits.callbacks = 2;
  const Service service = server.register_service("board", board, options);
  auto stub = client.connect<BoardStub>(
      "rr+tcp://127.0.0.1:" + std::to_string(server.listen_tcp(0, "127.0.0.1")) +
      "/?service=board");
  Gate gate;
  stub->sum().set([&](std::int32_t a, std::int32_t b) {
    gate.pass();
    return a + b;
  });
  const std::uint32_t number = service->clients().at(0).endpoint;
  std::vector<std::future<std::int32_t>> answers;
  for (int i = 0; i < 2; ++i) {
    answers.push_back(board->async_sum(number, i, 1, boost::asio::use_future));
  }
  EXPECT_EQ(code_of([&] { board->sum(number, 1, 1); }), ErrorCode::out_of_system_resource);
  gate.open();
  for (int i = 0; i < 2; ++i) EXPECT_EQ(answers[static_cast<std::size_t>(i)].get(), i + 1);
  EXPECT_EQ(board->sum(number, 1, 1), 2);
}

// A counter whose children have monitors.
class Monitored : public Counter {
 public:
  [[nodiscard]] bool rr_has_monitor() const override { return true; }
  bool rr_monitor_enter(std::chrono::milliseconds) override { return true; }
  void rr_monitor_exit() override {}
  std::shared_ptr<Skeleton> get_by_number(std::int32_t) override {
    return std::make_shared<Monitored>();
  }
};

TEST(ServiceLimits, TheMonitorsOfASessionAreCounted) {
  ServiceOptions options;
  options.limits.monitors = 2;
  Pair pair({}, {}, std::make_shared<Monitored>(), options);
  auto first = pair.connect();
  for (int i = 0; i < 2; ++i) enter_monitor(*first->get_by_number(i));
  const auto third = first->get_by_number(2);
  EXPECT_EQ(code_of([&] { enter_monitor(*third); }), ErrorCode::out_of_system_resource);
  auto second = pair.connect();
  enter_monitor(*second->get_by_number(2));
  exit_monitor(*second->get_by_number(2));
  exit_monitor(*first->get_by_number(0));
  EXPECT_NO_THROW(enter_monitor(*third));
}

TEST(ServiceLimits, TheLocksOfASessionAreCounted) {
  ServiceOptions options;
  options.limits.locks = 2;
  options.users =
      std::make_shared<PasswordUsers>("alice " + PasswordUsers::hash("right") + " objectlock\n");
  Pair pair({}, {}, std::make_shared<Counter>(), options);
  auto client = pair.connect({.username = "alice", .credentials = {{"password", "right"}}});
  for (int i = 0; i < 2; ++i) lock(*client->get_by_number(i));
  const auto third = client->get_by_number(2);
  EXPECT_EQ(code_of([&] { lock(*third); }), ErrorCode::out_of_system_resource);
  unlock(*client->get_by_number(0));
  EXPECT_NO_THROW(lock(*third));
}

// A counter whose children tell when they are released.
class Parent : public Counter {
 public:
  class Child : public Counter {
   public:
    explicit Child(Parent& parent) : parent_(parent) {}
    void rr_released(const std::string& path) override {
      const std::lock_guard lock(parent_.mutex);
      parent_.released.push_back(path);
    }

   private:
    Parent& parent_;
  };
  std::shared_ptr<Skeleton> get_by_name(const std::string&) override {
    return std::make_shared<Child>(*this);
  }
  std::size_t count_released() {
    const std::lock_guard lock(mutex);
    return released.size();
  }

  std::mutex mutex;
  std::vector<std::string> released;
};

TEST(ServiceLimits, TheObjectsOfAServiceAreCounted) {
  auto parent = std::make_shared<Parent>();
  ServiceOptions options;
  options.limits.objects = 10;
  Pair pair({}, {}, parent, options);
  {
    auto client = pair.connect();
    for (int i = 0; i < 10; ++i) client->get_by_name("n" + std::to_string(i))->get_value();
    const Error error = error_of([&] { client->get_by_name("one_more"); });
    EXPECT_EQ(error.code(), ErrorCode::out_of_system_resource);
    EXPECT_THAT(error.message(), ::testing::HasSubstr("10"));
    EXPECT_EQ(client->get_by_name("n3")->get_value(), 0);  // those that are there stay in use
  }
  EXPECT_TRUE(eventually([&] { return pair.service->clients().empty(); }));
  EXPECT_EQ(parent->count_released(), 0U);
  // What nobody uses any more gives way.
  auto next = pair.connect();
  EXPECT_TRUE(eventually(
      [&] { return code_of([&] { next->get_by_name("one_more"); }) == ErrorCode::none; }));
  EXPECT_TRUE(eventually([&] { return parent->count_released() == 10; }));
}

TEST(ServiceLimits, ObjectsOfDepartedSessionsAreReleasedWhereThereAreMany) {
  auto parent = std::make_shared<Parent>();
  ServiceOptions options;
  options.limits.unused_objects = 4;
  Pair pair({}, {}, parent, options);
  auto stays = pair.connect();
  stays->get_by_name("shared")->set_value(7);
  {
    auto leaves = pair.connect();
    for (int i = 0; i < 3; ++i) leaves->get_by_name("few" + std::to_string(i))->get_value();
  }
  EXPECT_TRUE(eventually([&] { return pair.service->clients().size() == 1; }));
  {
    auto leaves = pair.connect();
    for (int i = 0; i < 5; ++i) leaves->get_by_name("many" + std::to_string(i))->get_value();
    EXPECT_EQ(leaves->get_by_name("shared")->get_value(), 7);
    EXPECT_EQ(parent->count_released(), 0U);  // four were not too many
  }
  EXPECT_TRUE(eventually([&] { return parent->count_released() == 8; }));
  EXPECT_EQ(stays->get_by_name("shared")->get_value(), 7);
}

TEST(ServiceLimits, ObjectsOfDepartedSessionsAreReleasedWhereTheirPathsAreLong) {
  auto parent = std::make_shared<Parent>();
  ServiceOptions options;
  options.limits.unused_objects = 4;
  Pair pair({}, {}, parent, options);
  {
    auto leaves = pair.connect();
    leaves->get_by_name("short")->get_value();
  }
  EXPECT_TRUE(eventually([&] { return pair.service->clients().empty(); }));
  EXPECT_EQ(parent->count_released(), 0U);
  {
    auto leaves = pair.connect();
    leaves->get_by_name(std::string(4 * 512, 'x'))->get_value();
  }
  EXPECT_TRUE(eventually([&] { return parent->count_released() == 2; }));
}

// Containers

TEST(ServiceLimits, TheMemoryOfTheContainersOfARequestIsLimited) {
  NodeOptions options;
  options.budget.containers = 64 * 1024;
  Pair pair(options);
  auto client = pair.connect();
  VarList few(100);
  VarList many(4'000);
  EXPECT_EQ(client->any(VarValue(few)).get<VarList>().size(), 100U);
  EXPECT_EQ(code_of([&] { client->any(VarValue(many)); }), ErrorCode::out_of_system_resource);
  EXPECT_EQ(client->any(VarValue(few)).get<VarList>().size(), 100U);
}

TEST(ServiceLimits, TheMemoryOfContainersIsDrawnFromTheAccountOfTheClient) {
  NodeOptions options;
  options.budget = {.before_session = 1 * mib, .sessions = 1 * mib};
  Pair pair(options);
  auto client = pair.connect();
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(client->any(VarValue(VarList(5'000))).get<VarList>().size(), 5'000U);
    EXPECT_EQ(code_of([&] { client->any(VarValue(VarList(40'000))); }),
              ErrorCode::out_of_system_resource);
  }
}

}  // namespace
}  // namespace rr::testing
