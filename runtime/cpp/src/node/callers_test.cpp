// SPDX-License-Identifier: Apache-2.0
// Callers that share a connection.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <numeric>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "rr/options.hpp"
#include "runtime/cpp/src/channel/stream_connection.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/raw_peer.hpp"

namespace rr::testing {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t caller_count = 8;

// Ends the call of the caller whose number the answer has.
class Callers final : public channel::Receiver {
 public:
  std::array<std::atomic<channel::Waiter*>, caller_count> waiting{};
  channel::Connection* connection = nullptr;
  std::atomic<bool> is_closed{false};

  void take_answer(const Message& /*message*/, const Entry& entry, const MemoryRef& /*owner*/,
                   channel::DeferredCallbacks& /*deferred*/) override {
    channel::Waiter* const waiter = waiting.at(entry.request_id).exchange(nullptr);
    if (waiter != nullptr) connection->finish_answered(*waiter);
  }
  void handle(const Message& /*message*/, const Entry& /*first*/,
              const MemoryRef& /*owner*/) override {}
  void lost(const Error& /*why*/, channel::DeferredCallbacks& /*deferred*/) override {
    for (auto& each : waiting) {
      if (channel::Waiter* const waiter = each.exchange(nullptr)) connection->finish(*waiter);
    }
  }
  void closed() override { is_closed = true; }
};

class SharedConnection : public ::testing::Test {
 protected:
  SharedConnection() {
    reactor_->start();
    int other = -1;
    peer_.emplace(RawPeer::PairedByTcp{other});
    connection_ = std::make_shared<channel::StreamConnection>(
        channel::StreamConnection::Role::client, channel::Descriptor(other), reactor_, options_);
    callers_->connection = connection_.get();
    connection_->start(callers_);
  }
  ~SharedConnection() override {
    connection_->close(Error(ErrorCode::connection_error, "the test is over"));
    EXPECT_TRUE(eventually([&] { return callers_->is_closed.load(); }));
    reactor_->connections().wait_for_none();
    reactor_->stop();
  }

  // One call; false when its time was over.
  bool call(std::uint32_t number, channel::Time deadline = channel::never) {
    Writer writer;
    writer.reset(MessageVersion::v2);
    writer.entry({.type = EntryType::function_call_req, .request_id = number}, 0,
                 writer.position());
    writer.message({}, 1);
    channel::Waiter waiter;
    callers_->waiting.at(number) = &waiter;
    const channel::Time now = channel::Clock::now();
    connection_->claim(waiter);
    connection_->send_call(writer, now, channel::Priority::usual);
    connection_->wait(waiter, deadline, now);
    if (waiter.is_done()) return true;
    if (callers_->waiting.at(number).exchange(nullptr) != nullptr) return false;
    connection_->wait(waiter, channel::never, now);  // somebody is ending it
    return true;
  }
  // Takes so many requests; returns how many segments they came in.
  std::uint32_t take_requests(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(peer_->next_type(), EntryType::function_call_req);
    }
    const std::uint32_t now = peer_->data_segments_received();
    return now - std::exchange(segments_, now);
  }
  // Sends the answers to some at once.
  void answer(const std::vector<std::uint32_t>& numbers) {
    std::vector<std::byte> bytes;
    for (const std::uint32_t number : numbers) {
      Writer writer;
      writer.reset(MessageVersion::v2);
      writer.entry({.type = EntryType::function_call_res, .request_id = number}, 0,
                   writer.position());
      writer.message({}, 1);
      const std::vector<std::byte> one = writer.copy();
      bytes.insert(bytes.end(), one.begin(), one.end());
    }
    peer_->send(bytes);
  }
  void answer_all() {
    std::vector<std::uint32_t> numbers(caller_count);
    std::iota(numbers.begin(), numbers.end(), 0U);
    answer(numbers);
  }

  std::shared_ptr<const NodeOptions> options_ =
      std::make_shared<NodeOptions>(NodeOptions{.heartbeat_period = 120s});
  std::shared_ptr<channel::Reactor> reactor_ = std::make_shared<channel::Reactor>(2);
  std::shared_ptr<Callers> callers_ = std::make_shared<Callers>();
  std::optional<RawPeer> peer_;
  std::shared_ptr<channel::StreamConnection> connection_;
  std::uint32_t segments_ = 0;
};

// On a crowded machine they come too late for each other now and then.
TEST_F(SharedConnection, SendsTogetherWhatCallersAskThatWereAnsweredTogether) {
  std::atomic<bool> is_over{false};
  std::vector<std::jthread> threads;
  for (std::uint32_t number = 0; number < caller_count; ++number) {
    threads.emplace_back([&, number] {
      while (!is_over) EXPECT_TRUE(call(number));
    });
  }
  std::uint32_t fewest = caller_count;
  const auto deadline = channel::Clock::now() + 60s;
  take_requests(caller_count);
  while (fewest > caller_count / 2 && channel::Clock::now() < deadline) {
    answer_all();
    fewest = std::min(fewest, take_requests(caller_count));
  }
  EXPECT_LE(fewest, caller_count / 2);
  is_over = true;
  answer_all();
}

// Those that were woken and do not come are not waited for.
TEST_F(SharedConnection, SendsAtOnceWhatALoneCallerAsks) {
  std::vector<std::jthread> threads;
  for (std::uint32_t number = 0; number < caller_count; ++number) {
    threads.emplace_back([&, number] { EXPECT_TRUE(call(number)); });
  }
  take_requests(caller_count);
  answer_all();
  threads.clear();
  for (int i = 0; i < 100; ++i) {
    std::jthread alone([&] { EXPECT_TRUE(call(3)); });
    take_requests(1);
    answer({3});
  }
}

// Who reads and those that it wakes do not call again; somebody has to read on for the last one.
TEST_F(SharedConnection, IsReadOnWhenWhoHasReadDoesNotComeBack) {
  for (int i = 0; i < 50; ++i) {
    std::vector<std::jthread> threads;
    for (std::uint32_t number = 0; number < 3; ++number) {
      threads.emplace_back([&, number] { EXPECT_TRUE(call(number, channel::Clock::now() + 10s)); });
      take_requests(1);
      std::this_thread::sleep_for(1ms);  // it waits by then, mostly
    }
    answer({0, 1});
    std::this_thread::sleep_for(1ms);
    answer({2});
    threads.clear();
    if (HasFailure()) return;
  }
}

// Each call is ended by its answer, or gives up shortly before.
TEST_F(SharedConnection, LosesNoCallerThatGivesUp) {
  constexpr int rounds = 300;
  std::atomic<unsigned> left{caller_count};
  std::atomic<int> answered{0};
  std::atomic<int> given_up{0};
  std::vector<std::jthread> threads;
  for (std::uint32_t number = 0; number < caller_count; ++number) {
    threads.emplace_back([&, number] {
      for (int i = 0; i < rounds; ++i) {
        const auto patience =
            std::chrono::microseconds(number % 2 == 0 ? 20'000'000 : 20 * (i % 20));
        ++(call(number, channel::Clock::now() + patience) ? answered : given_up);
      }
      --left;
    });
  }
  std::vector<std::uint32_t> asked;
  for (unsigned taken = 0; taken < caller_count * rounds; ++taken) {
    const RawPeer::Received request = peer_->next();
    ASSERT_EQ(request.type, EntryType::function_call_req);
    asked.push_back(request.request_id);
    // Several at once; the last ones may be alone.
    if (asked.size() < 3 && left > 3) continue;
    answer(std::exchange(asked, {}));
  }
  answer(asked);
  threads.clear();
  EXPECT_EQ(answered + given_up, static_cast<int>(caller_count) * rounds);
  EXPECT_GE(answered, static_cast<int>(caller_count) / 2 * rounds);
}

}  // namespace
}  // namespace rr::testing
